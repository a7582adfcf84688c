#pragma once

#include <chrono>
#include <optional>

#include "engine/gl/unique_id.h"

namespace reljef::gl {

/// GPU time of the commands between begin() and end(). One query may run at a time in a context.
class TimerQuery {
public:
    TimerQuery() = default;
    static TimerQuery create();

    void begin();
    void end();
    /// The last measured time; empty until the GPU has finished. Never waits.
    [[nodiscard]] std::optional<std::chrono::nanoseconds> poll() const;

    [[nodiscard]] unsigned int id() const { return id_.get(); }

private:
    UniqueId<delete_query> id_;
    bool ended_ = false;
};

} // namespace reljef::gl
