#pragma once

#include <nlohmann/json.hpp>

#include "bench/report/environment.h"

namespace reljef::bench {

/// As all results files hold it.
nlohmann::ordered_json environment_json(const Environment& environment);

} // namespace reljef::bench
