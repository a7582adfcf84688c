#pragma once

#include <memory>
#include <span>

#include "engine/core/result.h"

namespace reljef::platform {

/// A library opened at run time, its names kept apart from those of other libraries. Its code stays
/// in memory after it is closed: GL drivers leave thread-local and exit handlers behind.
class SharedLibrary {
public:
    /// The first of `names` that opens. Fails with the loader's words for the first name.
    static Result<SharedLibrary> open(std::span<const char* const> names);

    /// The function of that name as a pointer of type F; null when there is none.
    template <class F> [[nodiscard]] F function(const char* name) const {
        return reinterpret_cast<F>(address(name));
    }

private:
    struct Close {
        void operator()(void* handle) const;
    };

    explicit SharedLibrary(void* handle) : handle_(handle) {}
    [[nodiscard]] void* address(const char* name) const;

    std::unique_ptr<void, Close> handle_;
};

} // namespace reljef::platform
