#pragma once

#include <filesystem>
#include <string_view>

#include <gtest/gtest.h>

namespace reljef::test {

/// A file or folder of the test data, "natural/x.tif": below the folder named by the environment
/// variable RELJEF_DATA, else below shared/data beside the source folder. It may not exist.
std::filesystem::path data_path(std::string_view relative);

/// Whether `data_path(relative)` exists and can be read.
bool has_data(std::string_view relative);

} // namespace reljef::test

/// Skips the test, with the reason, where the test data lacks `relative`.
#define RELJEF_NEED_DATA(relative)                                                                 \
    do {                                                                                           \
        if (!::reljef::test::has_data(relative)) {                                                 \
            GTEST_SKIP() << "test data " << ::reljef::test::data_path(relative)                    \
                         << " is missing; RELJEF_DATA names the folder that holds it";             \
        }                                                                                          \
    } while (false)
