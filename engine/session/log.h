#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/core/parallel_for.h"

namespace reljef::session {

/// What a message is about.
enum class MessageKind {
    note,         ///< something the user should know; the picture is as asked for
    left_out,     ///< a source file that could not be read when the terrain was opened
    shown_coarser ///< a source file that could not be read later; coarser tiles stand in for it
};

/// A long operation while it runs; it ends with the object.
class Task {
public:
    virtual ~Task() = default;
    /// `fraction` in [0,1]; any thread, one at a time.
    virtual void update(double fraction) = 0;
    /// For options that take a Progress; valid as long as this task.
    [[nodiscard]] Progress callback() {
        return [this](double fraction) { update(fraction); };
    }
};

/// Receives what a session reports. The session calls it on the thread that called the session.
/// This one ignores everything.
class Log {
public:
    virtual ~Log() = default;
    /// One sentence without a line end.
    virtual void message(MessageKind /*kind*/, std::string_view /*sentence*/) {}
    /// Begins a task, "reading alps.tif". Never null.
    [[nodiscard]] virtual std::unique_ptr<Task> start(const std::string& label);

    void note(std::string_view sentence) { message(MessageKind::note, sentence); }
};

/// Takes messages and progress from a thread in the background and hands them to another thread.
class RelayedLog : public Log {
public:
    void message(MessageKind kind, std::string_view sentence) override;
    [[nodiscard]] std::unique_ptr<Task> start(const std::string& label) override;

    /// Hands the messages since the last call to another log.
    void relay_to(Log& log);

    /// The task under way, "reading alps.tif", and how far it is, [0,1]; an empty label where there
    /// is none.
    struct TaskProgress {
        std::string label;
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
