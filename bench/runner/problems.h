#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/core/result.h"

namespace reljef::bench {

/// Sentences on what could not be measured, each once. A suite measures the rest and fails at its
/// end.
class Problems {
public:
    void add(const Error& error) {
        if (std::find(sentences_.begin(), sentences_.end(), error.message) == sentences_.end()) {
            sentences_.push_back(error.message);
        }
    }

    [[nodiscard]] const std::vector<std::string>& sentences() const { return sentences_; }

    /// Fails with all sentences; not without any.
    [[nodiscard]] Result<void> end() const {
        return sentences_.empty() ? Result<void>()
                                  : Error{fmt::format("{}", fmt::join(sentences_, "; "))};
    }

private:
    std::vector<std::string> sentences_;
};

} // namespace reljef::bench
