"""The water that every program is given: the column of scenes/collapse.toml, cut into n layers along its shortest edge."""
import math

EDGE_M = 0.4  # the column is EDGE x 2 EDGE x EDGE, the container 4 EDGE x 4 EDGE x EDGE
GRAVITY_M_S2 = 9.81
REST_DENSITY_KG_M3 = 1000.0
VISCOSITY_M2_S = 3.5e-3  # of collapse.toml; SPlisHSPlasH's standard viscosity takes the same number
ARTIFICIAL_VISCOSITY = 0.1  # alpha: squall's default for wcsph, and what DualSPHysics is told
GAMMA = 7
SUPPORT_RATIO = 2  # H / dx in all programs


class Column:
    """n layers along the shortest edge: 2 n^3 particles; 18 are the 11,664 of collapse.toml."""

    def __init__(self, layers):
        self.layers = layers
        self.spacing = EDGE_M / layers
        self.particles = 2 * layers**3
        # Ten times the speed of water that fell through its own depth: squall's default for collapse.toml.
        self.speed_of_sound = 10.0 * math.sqrt(GRAVITY_M_S2 * 2.0 * EDGE_M)
        # Pressure scale of Tait's equation, p = B ((rho / rho0)^gamma - 1).
        self.tait_b = REST_DENSITY_KG_M3 * self.speed_of_sound**2 / GAMMA
        self.mass = REST_DENSITY_KG_M3 * self.spacing**3

    def water(self):
        """Indices (i, j, k) of water, x fastest; a particle is at (index + 1/2) spacings. y points up."""
        n = self.layers
        return ((i, j, k) for k in range(n) for j in range(2 * n) for i in range(n))

    def walls(self):
        """Indices of wall particles, for programs whose walls are particles: one layer behind floor and side walls. Walls
        end four layers above the water, which does not rise before it has met the far wall."""
        n = self.layers
        for j in range(-1, 2 * n + 4):
            for k in range(-1, n + 1):
                for i in range(-1, 4 * n + 1):
                    if j < 0 or i in (-1, 4 * n) or k in (-1, n):
                        yield i, j, k

    def toml(self, frame_rate_hz=None):
        """The scene for squall. Without a frame rate, frames are as short as it allows: they are the samples of which the median is taken."""
        edge, n = EDGE_M, self.layers
        return f"""schema = 1
[time]
duration_s = 6.0
frame_rate_hz = {frame_rate_hz or (600 if n < 30 else 1000)}
[fluid]
spacing_m = {self.spacing!r}
viscosity_m2_s = {VISCOSITY_M2_S}
[solver]
artificial_viscosity = {ARTIFICIAL_VISCOSITY}
[container]
min_m = [0.0, 0.0, 0.0]
max_m = [{4 * edge}, {4 * edge}, {edge}]
open_top = true
[[block]]
min_m = [0.0, 0.0, 0.0]
max_m = [{edge}, {2 * edge}, {edge}]
"""
