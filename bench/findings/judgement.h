#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "bench/findings/committed_results.h"
#include "bench/findings/conclusion.h"
#include "engine/core/result.h"

namespace reljef::bench {

enum class Finding {
    confirmed,    ///< each figure lies in its range
    refuted,      ///< none does
    depends,      ///< some do
    open,         ///< none lies outside, but noise leaves open whether all lie inside
    answered,     ///< the source makes no claim
    not_measured, ///< a figure is missing
};
std::string_view to_string(Finding verdict);

struct Judgement {
    Finding verdict = Finding::not_measured;
    /// One for each figure; empty: not measured.
    std::vector<std::optional<Number>> numbers;
};

/// Fails as CommittedResults::number.
Result<std::optional<Number>> number_of(const Figure& figure, const CommittedResults& results);

/// Fails as CommittedResults::number.
Result<Judgement> judge(const Conclusion& conclusion, const CommittedResults& results);

/// The verdict on a conclusion with a rule. Precondition: a number for each figure.
Finding verdict_of(std::span<const Figure> figures, std::span<const std::optional<Number>> numbers);

} // namespace reljef::bench
