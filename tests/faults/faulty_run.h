#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/support/temporary_folder.h"
#include "tests/support/test_program.h"

namespace reljef::test {

/// The contents of files by their names.
using FileContents = std::map<std::string, std::string>;

/// A run of `reljef` in a folder of its own, with a small DEM and a cache.
class FaultyRun {
public:
    /// `variables`: of fault_library.cpp. `before`: outputs that are there already.
    FaultyRun(const std::vector<std::string>& arguments,
              const std::map<std::string, std::string>& variables, const FileContents& before = {});

    [[nodiscard]] const ProgramResult& result() const { return result_; }
    /// All files, also hidden ones, but the DEM and the cache.
    [[nodiscard]] const FileContents& files() const { return files_; }
    /// What the library wrote, lines (RELJEF_FAULT_LIST, RELJEF_FAULT_COUNT).
    [[nodiscard]] const std::vector<std::string>& told() const { return told_; }
    /// Whether the call failed that RELJEF_FAULT names.
    [[nodiscard]] bool has_failed() const { return has_failed_; }
    /// Runs it again in the same folder, without a fault.
    void repeat();

private:
    void run(const std::map<std::string, std::string>& variables);

    TemporaryFolder folder_;
    std::vector<std::string> arguments_;
    ProgramResult result_;
    FileContents files_;
    std::vector<std::string> told_;
    bool has_failed_ = false;
};

} // namespace reljef::test
