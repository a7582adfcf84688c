#include "engine/session/log.h"

namespace reljef::session {

std::unique_ptr<Task> Log::start(const std::string& /*label*/) {
    return std::make_unique<Task>();
}

class RelayedTask : public Task {
public:
    RelayedTask(RelayedLog& log, std::string label) : log_(log), label_(std::move(label)) {
        log_.set_progress({label_, 0.0});
    }
    ~RelayedTask() override { log_.set_progress({}); }
    RelayedTask(const RelayedTask&) = delete;
    RelayedTask& operator=(const RelayedTask&) = delete;

    void update(double fraction) override { log_.set_progress({label_, fraction}); }

private:
    RelayedLog& log_;
    std::string label_;
};

void RelayedLog::message(MessageKind kind, std::string_view sentence) {
    const std::lock_guard lock(mutex_);
    messages_.emplace_back(kind, sentence);
}

std::unique_ptr<Task> RelayedLog::start(const std::string& label) {
    return std::make_unique<RelayedTask>(*this, label);
}

void RelayedLog::relay_to(Log& log) {
    std::vector<std::pair<MessageKind, std::string>> messages;
    {
        const std::lock_guard lock(mutex_);
        messages = std::exchange(messages_, {});
    }
    for (const auto& [kind, sentence] : messages) {
        log.message(kind, sentence);
    }
}

RelayedLog::TaskProgress RelayedLog::progress() const {
    const std::lock_guard lock(mutex_);
    return progress_;
}

void RelayedLog::set_progress(TaskProgress progress) {
    const std::lock_guard lock(mutex_);
    progress_ = std::move(progress);
}

} // namespace reljef::session
