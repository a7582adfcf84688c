#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace reljef::gl {

enum class Severity { low, medium, high };

/// "low", "medium", "high".
std::string_view to_string(Severity severity);

struct DebugMessage {
    Severity severity = Severity::low;
    bool error = false; ///< a GL error, e.g. an invalid enum
    unsigned int id = 0;
    std::string text;
};

/// Collects what the driver says about the current context for as long as it lives; mere
/// notifications are left out. Complete on a debug context (ContextOptions::debug) only. Messages
/// arrive inside the GL call that causes them. Destroy it while the context is still current.
class DebugLog {
public:
    DebugLog();
    DebugLog(DebugLog&&) noexcept;
    DebugLog& operator=(DebugLog&&) = delete;
    DebugLog(const DebugLog&) = delete;
    DebugLog& operator=(const DebugLog&) = delete;
    ~DebugLog();

    [[nodiscard]] const std::vector<DebugMessage>& messages() const;
    /// The texts of errors and of everything above low severity: empty where all is well.
    [[nodiscard]] std::vector<std::string> problems() const;
    void clear();

private:
    std::unique_ptr<std::vector<DebugMessage>> messages_;
};

} // namespace reljef::gl
