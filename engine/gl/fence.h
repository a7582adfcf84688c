#pragma once

#include <memory>

namespace reljef::gl {

/// Marks a place among the commands of a context. It must be current when a fence is made, used and
/// destroyed.
class Fence {
public:
    Fence() = default; ///< wait() returns at once
    /// After all commands so far, whose work begins without waiting for further ones.
    static Fence after_commands();

    /// Waits until the commands before it are done, or the context has failed.
    void wait() const;

private:
    struct Deleter {
        void operator()(void* sync) const;
    };
    std::unique_ptr<void, Deleter> sync_;
};

} // namespace reljef::gl
