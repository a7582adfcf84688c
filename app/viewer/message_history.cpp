#include "app/viewer/message_history.h"

#include <limits>

namespace reljef::app {

void MessageHistory::message(session::MessageKind kind, std::string_view sentence) {
    next_.message(kind, sentence);
    keep(sentence, kind != session::MessageKind::note);
}

void MessageHistory::confirm(std::string_view sentence) {
    keep(sentence, false);
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
