#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "engine/core/result.h"

namespace reljef {

/// A file in memory with a path, for libraries that write to paths and report disk errors badly.
class MemoryFile {
public:
    /// Fails without a free file descriptor or memory.
    static Result<MemoryFile> create();

    MemoryFile(MemoryFile&& other) noexcept;
    MemoryFile& operator=(MemoryFile&&) = delete;
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;
    ~MemoryFile();

    /// Valid in this process only.
    [[nodiscard]] std::filesystem::path path() const;
    [[nodiscard]] int descriptor() const { return descriptor_; }
    [[nodiscard]] Result<std::vector<std::byte>> bytes() const;

private:
    explicit MemoryFile(int descriptor) : descriptor_(descriptor) {}

    int descriptor_;
};

} // namespace reljef
