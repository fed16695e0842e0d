#pragma once

#include <string>

#include "core/particles.h"

namespace squall {

/// Reads particles from a CSV file: the header `x,y,z,vx,vy,vz`, then one particle per line, six finite numbers in SI
/// units separated by commas alone; lines end in \n or \r\n, and there are no empty lines. Ids count lines from 0.
/// Throws InputError with file:line:column.
Particles read_particle_csv(const std::string& path);

/// The same from text; `path` names it in messages.
Particles parse_particle_csv(const std::string& text, const std::string& path);

}  // namespace squall
