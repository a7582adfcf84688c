#include "app/viewer/message_history.h"

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <limits>

#include <fmt/format.h>

namespace reljef::app {
namespace {

// Up to a line that does not begin with a blank, without its end.
std::string_view first_result(std::string_view lines) {
    std::size_t end = lines.find('\n');
    while (end != lines.npos && end + 1 < lines.size() && lines[end + 1] == ' ') {
        end = lines.find('\n', end + 1);
    }
    return lines.substr(0, end);
}

} // namespace

void MessageHistory::message(session::MessageKind kind, std::string_view sentence) {
    next_.message(kind, sentence);
    keep(sentence, kind != session::MessageKind::note);
}

void MessageHistory::report(std::string_view lines) {
    fmt::print(results_, "{}", lines);
    std::fflush(results_);
    while (!lines.empty()) {
        const std::string_view result = first_result(lines);
        keep(result, false);
        lines.remove_prefix(std::min(result.size() + 1, lines.size()));
    }
}

void MessageHistory::keep(std::string_view sentence, bool is_error) {
    if (messages_.size() == max_messages) {
        messages_.erase(messages_.begin());
    }
    messages_.push_back({std::string(sentence), is_error, clock_.seconds()});
}

std::vector<MessageContent> MessageHistory::messages() const {
    std::vector<MessageContent> aged = messages_;
    for (MessageContent& message : aged) {
        message.age = clock_.seconds() - message.age;
    }
    return aged;
}

double MessageHistory::youngest() const {
    return messages_.empty() ? std::numeric_limits<double>::infinity()
                             : clock_.seconds() - messages_.back().age;
}

} // namespace reljef::app
