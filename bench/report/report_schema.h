#pragma once

#include <string_view>

namespace reljef::bench {

/// What a results file says it is, under "schema".
inline constexpr std::string_view schema_name = "reljef-bench/1";

} // namespace reljef::bench
