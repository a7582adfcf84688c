#pragma once

#include <string>
#include <vector>

#include "app/cli/program.h"

namespace reljef::cli {

struct ManualFile {
    std::string path; ///< below the installation's share folder, "man/man1/reljef-render.1"
    std::string text;
};

/// Manual pages for the program and each verb, and completions for bash and zsh.
std::vector<ManualFile> manual_of(const Program& program);

/// Writes these files below a folder. Returns the exit status; errors are on stderr.
int write_manual(const Program& program, const std::string& folder);

} // namespace reljef::cli
