#pragma once

#include <chrono>
#include <optional>

#include "engine/gl/unique_id.h"

namespace reljef::gl {

/// GPU time of the commands between begin() and end(). One may run at a time in a context. To
/// measure every frame without waiting, use several in turn. Default-constructed and moved-from
/// ones hold nothing (id 0).
class TimerQuery {
public:
    TimerQuery() = default;
    static TimerQuery create();

    void begin();
    void end();
    /// The time of the last begin() … end(), once the GPU has done it; never waits.
    [[nodiscard]] std::optional<std::chrono::nanoseconds> poll() const;

    [[nodiscard]] unsigned int id() const { return id_.get(); }

private:
    UniqueId<delete_query> id_;
    bool ended_ = false;
};

} // namespace reljef::gl
