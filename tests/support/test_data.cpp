#include "tests/support/test_data.h"

#include <cstdlib>

#include <unistd.h>

namespace reljef::test {

std::filesystem::path data_path(std::string_view relative) {
    const char* const chosen = std::getenv("RELJEF_DATA");
    const std::filesystem::path folder =
        chosen != nullptr && *chosen != '\0' ? chosen : RELJEF_TEST_DATA_FOLDER;
    return (folder / relative).lexically_normal();
}

bool has_data(std::string_view relative) {
    return ::access(data_path(relative).c_str(), R_OK) == 0;
}

} // namespace reljef::test
