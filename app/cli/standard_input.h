#pragma once

#include <functional>
#include <stop_token>
#include <string>

#include "engine/core/result.h"

namespace reljef::cli {

/// Calls `run`. If `terrain` is "-", it names a temporary file with the bytes of standard input
/// meanwhile, because rasters are not read in order. A terminal is a usage error (CLI::ParseError).
/// Fails if nothing arrives, the disk is full, or `stop` is requested; for .hgt, .zip and .gz,
/// which GDAL reads by their names, with a sentence that says so.
Result<void> with_standard_input(std::string& terrain, const std::stop_token& stop,
                                 const std::function<Result<void>()>& run);

} // namespace reljef::cli
