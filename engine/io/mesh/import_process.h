#pragma once

#include <cstddef>
#include <filesystem>
#include <stop_token>
#include <vector>

#include "engine/core/result.h"

namespace reljef::io {

/// Limits of the process that imports a mesh.
struct ImportLimits {
    int seconds = 60;     ///< of computing; > 0. Three times as long is waited, on busy machines
    int megabytes = 3072; ///< of its addresses; > 0. Without effect under the sanitizers
    std::size_t max_answer = std::size_t{1} << 30U; ///< bytes
    /// The program reljef-mesh-import; empty: the one beside the running program, or of the
    /// installation.
    std::filesystem::path program = {};
};

/// What the import program writes to its standard output for a file: encoded_parts(). Errors are
/// one sentence that begins with the file. They cover a program that crashes, hangs, answers too
/// much, or is not there, and stop requests.
Result<std::vector<std::byte>> run_import(const std::filesystem::path& file,
                                          const ImportLimits& limits, const std::stop_token& stop);

/// For the import program: ends it at these limits. Fails if the system sets none.
Result<void> limit_this_process(int megabytes, int seconds);

/// Exit status of the import program: the answer is an error, without the file's name.
inline constexpr int import_failed = 3;

} // namespace reljef::io
