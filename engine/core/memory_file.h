#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "engine/core/result.h"

namespace reljef {

/// A file that lies in memory and has a name: for libraries that write to names and tell too little
/// of what went wrong on a disk. It goes when the object goes.
class MemoryFile {
public:
    /// Fails where the system has no descriptor or memory left.
    static Result<MemoryFile> create();

    MemoryFile(MemoryFile&& other) noexcept;
    MemoryFile& operator=(MemoryFile&&) = delete;
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;
    ~MemoryFile();

    /// Means this file in this process only.
    [[nodiscard]] std::filesystem::path path() const;
    [[nodiscard]] int descriptor() const { return descriptor_; }
    [[nodiscard]] Result<std::vector<std::byte>> bytes() const;

private:
    explicit MemoryFile(int descriptor) : descriptor_(descriptor) {}

    int descriptor_;
};

} // namespace reljef
