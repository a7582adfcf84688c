#include "engine/core/memory_file.h"

#include <cerrno>
#include <cstring>
#include <utility>

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

namespace reljef {

Result<MemoryFile> MemoryFile::create() {
    const int descriptor = ::memfd_create("reljef", MFD_CLOEXEC);
    if (descriptor < 0) {
        return Error{fmt::format("no file in memory can be made: {}", std::strerror(errno))};
    }
    return MemoryFile(descriptor);
}

MemoryFile::MemoryFile(MemoryFile&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)) {}

MemoryFile::~MemoryFile() {
    if (descriptor_ >= 0) {
        ::close(descriptor_);
    }
}

std::filesystem::path MemoryFile::path() const {
    return fmt::format("/proc/self/fd/{}", descriptor_);
}

Result<std::vector<std::byte>> MemoryFile::bytes() const {
    const off_t size = ::lseek(descriptor_, 0, SEEK_END);
    std::vector<std::byte> bytes(size > 0 ? static_cast<std::size_t>(size) : 0);
    std::size_t read = 0;
    while (read < bytes.size()) {
        const ssize_t count = ::pread(descriptor_, bytes.data() + read, bytes.size() - read,
                                      static_cast<off_t>(read));
        if (count <= 0) {
            return Error{fmt::format("a file in memory cannot be read: {}", std::strerror(errno))};
        }
        read += static_cast<std::size_t>(count);
    }
    return bytes;
}

} // namespace reljef
