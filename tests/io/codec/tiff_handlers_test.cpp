#include "engine/io/codec/tiff_handlers.h"

#include <atomic>
#include <chrono>
#include <cstdarg>
#include <thread>

#include <gtest/gtest.h>
#include <tiffio.h>

namespace reljef::io {
namespace {

std::atomic<int> counted{0};

void count_message(const char* /*module*/, const char* /*format*/, va_list /*values*/) {
    ++counted;
}

void drop_message(const char* /*module*/, const char* /*format*/, va_list /*values*/) {}

// What OpenImageIO does to the handlers in one thread, while another reads damaged files.
TEST(TiffHandlers, LoseNoMessageOfAnotherThread) {
    const TIFFErrorHandler error = TIFFSetErrorHandler(count_message);
    const TIFFErrorHandler warning = TIFFSetWarningHandler(count_message);
    counted = 0;
    std::atomic<bool> ends{false};
    std::atomic<int> failed{0};
    std::thread reader([&] {
        while (!ends) {
            EXPECT_EQ(TIFFOpen("no such file", "r"), nullptr);
            ++failed;
        }
    });
    keep_tiff_handlers([&] {
        TIFFSetErrorHandler(drop_message);
        TIFFSetWarningHandler(drop_message);
        const int before = failed;
        while (failed < before + 100) {
            std::this_thread::yield();
        }
    });
    ends = true;
    reader.join();
    EXPECT_GE(counted, failed);
    EXPECT_EQ(TIFFSetErrorHandler(error), count_message);
    EXPECT_EQ(TIFFSetWarningHandler(warning), count_message);
}

} // namespace
} // namespace reljef::io
