"""Writes the column as a case of DualSPHysics: an XML file of constants and a bi4 file of particles, which its GenCase would
write otherwise. z points up there, so (x, y, z) becomes (x, z, y)."""
import array
import struct

from column import ARTIFICIAL_VISCOSITY, GAMMA, GRAVITY_M_S2, REST_DENSITY_KG_M3, SUPPORT_RATIO

# Codes of value types in its binary files.
TEXT, BOOL, INT, UINT, ULLONG, FLOAT, DOUBLE, FLOAT3, DOUBLE3 = 1, 2, 7, 8, 10, 11, 12, 22, 23
PACKING = {BOOL: "<i", INT: "<i", UINT: "<I", ULLONG: "<Q", FLOAT: "<f", DOUBLE: "<d", DOUBLE3: "<3d"}


def text(value):
    data = value.encode()
    return struct.pack("<I", len(data)) + data


def encode(name, kind, value):
    head = text(name) + struct.pack("<i", kind)
    if kind == TEXT:
        return head + text(value)
    return head + struct.pack(PACKING[kind], *(value if kind == DOUBLE3 else (value,)))


def values_of(entries):
    return text("\nVALUES") + struct.pack("<I", len(entries)) + b"".join(encode(*entry) for entry in entries)


def item(name, entries, arrays, children):
    """An item of the file: its values, then its arrays, then the items inside it."""
    values = values_of(entries)
    head = (text("\nITEM\n") + text(name) + struct.pack("<ii", 0, 0) + text("%.7E") + text("%.15E")
            + struct.pack("<III", len(arrays), len(children), len(values)))
    return struct.pack("<I", len(head)) + head + values + b"".join(arrays) + b"".join(children)


def data_array(name, kind, count, data):
    head = text("\nARRAY") + text(name) + struct.pack("<iiII", 0, kind, count, len(data))
    return struct.pack("<I", len(head)) + head + data


def write_particles(column, path):
    """Walls first, as it wants them, then water at rest at rest density."""
    walls = list(column.walls())
    spacing, total = column.spacing, len(walls) + column.particles
    positions = array.array("d")
    for cells in (walls, column.water()):
        for i, j, k in cells:
            positions.extend(((i + 0.5) * spacing, (k + 0.5) * spacing, (j + 0.5) * spacing))
    low = [min(positions[axis::3]) for axis in range(3)]
    high = [max(positions[axis::3]) for axis in range(3)]
    part = item("PART_0000",
                [("Cpart", UINT, 0), ("TimeStep", DOUBLE, 0.0), ("Npok", UINT, total), ("Nout", UINT, 0), ("Step", UINT, 0),
                 ("RunTime", DOUBLE, 0.0), ("DomainMin", DOUBLE3, low), ("DomainMax", DOUBLE3, high)],
                [data_array("Idp", UINT, total, array.array("I", range(total)).tobytes()),
                 data_array("Posd", DOUBLE3, total, positions.tobytes()),
                 data_array("Vel", FLOAT3, total, bytes(12 * total)),
                 data_array("Rhop", FLOAT, total, array.array("f", [REST_DENSITY_KG_M3]).tobytes() * total)], [])
    zero = (0.0, 0.0, 0.0)
    case = item("JPartDataBi4",
                [("Piece", UINT, 0), ("Npiece", UINT, 1), ("RunCode", TEXT, "0"), ("Date", TEXT, ""), ("AppName", TEXT, "column"),
                 ("CaseName", TEXT, "column"), ("Data2d", BOOL, 0), ("CaseNp", ULLONG, total), ("CaseNfixed", ULLONG, len(walls)),
                 ("CaseNmoving", ULLONG, 0), ("CaseNfloat", ULLONG, 0), ("CaseNfluid", ULLONG, column.particles),
                 ("CasePosMin", DOUBLE3, low), ("CasePosMax", DOUBLE3, high), ("Dp", DOUBLE, spacing),
                 ("H", DOUBLE, support(column) / 2), ("B", DOUBLE, column.tait_b), ("Rhop0", DOUBLE, REST_DENSITY_KG_M3),
                 ("Gamma", DOUBLE, GAMMA), ("MassBound", DOUBLE, column.mass), ("MassFluid", DOUBLE, column.mass),
                 ("MapPosMin", DOUBLE3, zero), ("MapPosMax", DOUBLE3, zero), ("PeriMode", INT, 0), ("PeriXinc", DOUBLE3, zero),
                 ("PeriYinc", DOUBLE3, zero), ("PeriZinc", DOUBLE3, zero)], [], [part])
    with open(path, "wb") as file:
        file.write(b"#FileJBD JPartDataBi4".ljust(58) + b"\n\0" + bytes(4) + case)
    return len(walls)


def support(column):
    return SUPPORT_RATIO * column.spacing


def write_case(column, folder):
    """folder/column.xml and folder/column.bi4. Its smoothing length h is half the support."""
    walls = write_particles(column, f"{folder}/column.bi4")
    constants = {"cflnumber": 0.2, "gamma": GAMMA, "rhop0": REST_DENSITY_KG_M3, "dp": column.spacing, "h": support(column) / 2,
                 "b": column.tait_b, "massbound": column.mass, "massfluid": column.mass}
    # Verlet and Wendland are its defaults; artificial viscosity and diffusion of density as in its dam break.
    parameters = {"StepAlgorithm": 1, "VerletSteps": 40, "Kernel": 2, "ViscoTreatment": 1, "Visco": ARTIFICIAL_VISCOSITY,
                  "ViscoBoundFactor": 1, "DensityDT": 2, "DensityDTvalue": 0.1, "TimeMax": 10, "TimeOut": 10,
                  "PartsOutMax": 1, "RhopOutMin": 700, "RhopOutMax": 1300}
    lines = ['<?xml version="1.0" encoding="UTF-8" ?>', "<case>", "<execution>", "<parameters>"]
    lines += [f'<parameter key="{key}" value="{value}" />' for key, value in parameters.items()]
    lines += ["</parameters>", "<constants>", '<data2d value="false" />', f'<gravity x="0" y="0" z="{-GRAVITY_M_S2}" />']
    lines += [f'<{key} value="{value!r}" />' for key, value in constants.items()]
    total = walls + column.particles
    lines += ["</constants>", f'<particles np="{total}" nb="{walls}" nbf="{walls}" mkboundfirst="11" mkfluidfirst="1">',
              f'<fixed mkbound="0" mk="11" begin="0" count="{walls}" />',
              f'<fluid mkfluid="0" mk="1" begin="{walls}" count="{column.particles}" />', "</particles>", "</execution>", "</case>"]
    with open(f"{folder}/column.xml", "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")
