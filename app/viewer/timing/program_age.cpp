#include "app/viewer/timing/program_age.h"

#include <unistd.h>

#include <algorithm>
#include <ctime>
#include <fstream>
#include <sstream>
#include <string>

namespace reljef::app {

// The 22nd word: clock ticks from the system's start to the process's (proc(5), /proc/pid/stat).
// The second word, the program's name in brackets, may hold spaces and brackets.
Result<double> program_age() {
    constexpr int words_between = 19; // from the name to that word
    std::ifstream file("/proc/self/stat");
    std::string line;
    std::getline(file, line);
    std::istringstream words(line.substr(std::min(line.rfind(')') + 1, line.size())));
    std::string word;
    for (int i = 0; i < words_between; ++i) {
        words >> word;
    }
    double ticks = 0.0;
    timespec now{};
    const auto per_second = static_cast<double>(sysconf(_SC_CLK_TCK));
    if (!(words >> ticks) || per_second <= 0.0 || clock_gettime(CLOCK_BOOTTIME, &now) != 0) {
        return Error{"/proc/self/stat: the time when the program began is not found"};
    }
    constexpr double nanoseconds = 1e9;
    return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) / nanoseconds -
           ticks / per_second;
}

} // namespace reljef::app
