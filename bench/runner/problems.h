#pragma once

#include <algorithm>
#include <string>
#include <utility>
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
        std::string sentence;
        for (const char letter : error.message) { // a line is a sentence in end()
            sentence += letter == '\n' ? std::string("; ") : std::string(1, letter);
        }
        if (std::find(sentences_.begin(), sentences_.end(), sentence) == sentences_.end()) {
            sentences_.push_back(std::move(sentence));
        }
    }

    [[nodiscard]] const std::vector<std::string>& sentences() const { return sentences_; }

    /// Fails with all sentences, a line each; not without any.
    [[nodiscard]] Result<void> end() const {
        return sentences_.empty() ? Result<void>()
                                  : Error{fmt::format("{}", fmt::join(sentences_, "\n"))};
    }

private:
    std::vector<std::string> sentences_;
};

} // namespace reljef::bench
