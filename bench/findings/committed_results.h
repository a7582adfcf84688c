#pragma once

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>

#include <nlohmann/json.hpp>

#include "bench/findings/conclusion.h"
#include "engine/core/result.h"

namespace reljef::bench {

/// A measured number.
struct Number {
    double value = 0.0;
    double noise = 0.0;  ///< of its run: that of two numbers of one run is one
    double spread = 0.0; ///< of this number: that of others is independent

    /// How far the true number may be away.
    [[nodiscard]] double uncertainty() const { return std::max(noise, spread); }
};

/// Where results were measured.
struct Machine {
    std::string cpu;
    std::string renderer;
    unsigned threads = 1;
    std::string commit;
    bool has_gpu = false; ///< that drew
};

/// Results files of any suite, by their names.
class CommittedResults {
public:
    /// Reads those of the files that exist. Fails, in one sentence, if the folder does not exist,
    /// or if a file is damaged, ended early, or was written by a version with another schema.
    static Result<CommittedResults> read(const std::filesystem::path& folder,
                                         std::span<const std::string> files);

    [[nodiscard]] bool has(const std::string& file) const { return files_.contains(file); }

    /// Empty if the file, the row or the number does not exist. Fails if several rows have that
    /// name, or if the number has another type or is out of range.
    [[nodiscard]] Result<std::optional<Number>> number(const RowName& row, Quantity quantity) const;

    /// Settings that a run of pareto left out, for want of time.
    [[nodiscard]] std::size_t left_out(const std::string& file) const;

    /// That the file's results are of: "tables", "lod-growth"; empty if it does not name one.
    [[nodiscard]] std::string suite(const std::string& file) const;

    /// Empty if the file does not name its machine.
    [[nodiscard]] std::optional<Machine> machine(const std::string& file) const;

private:
    std::filesystem::path folder_;
    std::map<std::string, nlohmann::json> files_;
};

} // namespace reljef::bench
