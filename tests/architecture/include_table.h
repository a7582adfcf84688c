#pragma once

#include <string>
#include <string_view>

namespace reljef::test {

/// The part of a path before its last slash; "" without one.
std::string folder_of(std::string_view path);

/// The folder of a file of code, "engine/core" for engine/core/grid.h; "tests" for all tests; ""
/// for a file in no folder of the table.
std::string room_of(std::string_view path);

/// Whether a file of room `from` may include one of room `to`: its own room, the rooms of its row
/// with all that lies below them, and the rooms that are named for it alone.
bool may_include(std::string_view from, std::string_view to);

} // namespace reljef::test
