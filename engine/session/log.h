#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/core/parallel_for.h"

namespace reljef::session {

enum class MessageKind {
    note,         ///< information; the picture is as requested
    left_out,     ///< a source file could not be read when the terrain was opened
    shown_coarser ///< a source file could not be read later; coarser tiles replace it
};

/// A long operation; it ends with the object. This one shows nothing.
class Task {
public:
    virtual ~Task() = default;
    /// `fraction` in [0,1]; any thread, one at a time.
    virtual void update(double /*fraction*/) {}
    /// Valid as long as this task.
    [[nodiscard]] Progress callback() {
        return [this](double fraction) { update(fraction); };
    }
};

/// Receives messages and progress, on the thread that called the session. This one ignores them.
class Log {
public:
    virtual ~Log() = default;
    /// `sentence`: without a line end.
    virtual void message(MessageKind /*kind*/, std::string_view /*sentence*/) {}
    /// Begins a task such as "reading alps.tif". Never null.
    [[nodiscard]] virtual std::unique_ptr<Task> start(const std::string& label);

    void note(std::string_view sentence) { message(MessageKind::note, sentence); }
};

/// Passes messages and progress from a background thread to another thread.
class RelayedLog : public Log {
public:
    void message(MessageKind kind, std::string_view sentence) override;
    [[nodiscard]] std::unique_ptr<Task> start(const std::string& label) override;

    /// Passes the messages since the last call to another log.
    void relay_to(Log& log);

    struct TaskProgress {
        std::string label; ///< of the running task; empty if there is none
        double fraction = 0.0;
    };
    [[nodiscard]] TaskProgress progress() const;

private:
    friend class RelayedTask;
    void set_progress(TaskProgress progress);

    mutable std::mutex mutex_;
    std::vector<std::pair<MessageKind, std::string>> messages_;
    TaskProgress progress_;
};

} // namespace reljef::session
