#pragma once

namespace reljef::gl {

/// Whether the driver ran out of memory since the last call; takes all error flags (a DebugLog has
/// seen them in detail).
bool ran_out_of_memory();

} // namespace reljef::gl
