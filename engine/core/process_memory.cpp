#include "engine/core/process_memory.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <map>
#include <string>

namespace reljef {

// The kernel's lines "VmRSS:     1234 kB" (proc(5), /proc/pid/status).
ProcessMemory process_memory() {
    std::map<std::string, std::size_t> bytes;
    std::ifstream status("/proc/self/status");
    for (std::string name; status >> name;) {
        std::size_t kilobytes = 0;
        if ((name == "VmRSS:" || name == "VmHWM:" || name == "RssFile:") && status >> kilobytes) {
            bytes[name] = kilobytes << 10U;
        }
        status.clear();
        status.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
    }
    const std::size_t files = bytes["RssFile:"];
    return {bytes["VmRSS:"] - std::min(files, bytes["VmRSS:"]),
            bytes["VmHWM:"] - std::min(files, bytes["VmHWM:"])};
}

} // namespace reljef
