#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "app/viewer/panels/panel_content.h"
#include "engine/core/stopwatch.h"
#include "engine/session/log.h"

namespace reljef::app {

/// All sentences of the viewer. Passes messages on, prints results, and keeps the latest of both
/// for the panels.
class MessageHistory : public session::Log {
public:
    static constexpr std::size_t max_messages = 200;

    /// `next` outlives this. `results`: where report() writes.
    explicit MessageHistory(session::Log& next, std::FILE* results = stdout)
        : next_(next), results_(results) {}

    void message(session::MessageKind kind, std::string_view sentence) override;
    [[nodiscard]] std::unique_ptr<session::Task> start(const std::string& label) override {
        return next_.start(label);
    }
    /// Results of what the user does, as a saved file: writes lines with their ends. A line that
    /// begins with a blank continues the one before it.
    void report(std::string_view lines);

    /// Oldest first.
    [[nodiscard]] std::vector<MessageContent> messages() const;
    /// The youngest message's age, seconds; infinite without messages.
    [[nodiscard]] double youngest() const;

private:
    void keep(std::string_view sentence, bool is_error);

    session::Log& next_;
    std::FILE* results_;
    Stopwatch clock_;
    std::vector<MessageContent> messages_; // age: seconds on the clock at the arrival
};

} // namespace reljef::app
