#pragma once

#include <filesystem>

namespace reljef {

/// A file that belongs to reljef's programs: one that they start, or a library that they load when
/// they need it. It lies beside the running program, in `../libexec/reljef` from there, in the
/// folder that reljef's CMake package named to the program, or in that of the installation. The
/// first of these places if it is in none.
std::filesystem::path program_part(const char* name);

} // namespace reljef
