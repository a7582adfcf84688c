#pragma once

#include <cstddef>
#include <fstream>
#include <string>

namespace reljef::test {

/// Bytes that this process has read so far, from any file (proc(5), /proc/pid/io, rchar).
inline std::size_t bytes_read() {
    std::ifstream counters("/proc/self/io");
    std::string name;
    std::size_t bytes = 0;
    counters >> name >> bytes;
    return bytes;
}

} // namespace reljef::test
