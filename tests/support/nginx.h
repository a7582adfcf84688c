#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include <sys/types.h>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace reljef::test {

/// Debian's nginx on a port of the loopback, without privileges and with all its own files in a
/// folder of its own. It serves the files of a folder, ranges too, by rules in its own words.
class Nginx {
public:
    static bool is_installed();

    /// `rules`: directives of nginx's `server` block, as `return 404;`. Returns once it serves;
    /// aborts, with what nginx says, where it does not.
    explicit Nginx(std::filesystem::path root, const std::string& rules = "");
    ~Nginx();
    Nginx(const Nginx&) = delete;
    Nginx& operator=(const Nginx&) = delete;

    /// Starts anew on the same port, by other rules. Connections are cut, or refused meanwhile.
    void serve_by(const std::string& rules);

    [[nodiscard]] std::string url(const std::string& name) const;

    /// Of contents, in all answers so far; of the latest they may be missing.
    [[nodiscard]] std::size_t bytes_sent() const;

private:
    void start(const std::string& rules);
    void stop();

    std::filesystem::path root_;
    TemporaryFolder own_;
    int socket_ = -1; ///< keeps the port, which nginx shares; never listens
    int port_ = 0;
    pid_t process_ = -1;
};

/// Rules by which the length that is told of a file goes on being what it was when it was first
/// asked for: a lie once the file is cut, and then the connection ends before all of it has come.
inline constexpr const char* remembered_lengths =
    "open_file_cache max=16 inactive=1h; open_file_cache_valid 1h; open_file_cache_min_uses 1;";

} // namespace reljef::test

/// Skips the test, with the reason, where nginx is not installed.
#define RELJEF_NEED_NGINX()                                                                        \
    do {                                                                                           \
        if (!::reljef::test::Nginx::is_installed()) {                                              \
            GTEST_SKIP() << "nginx is not installed, ./dev test installs it";                      \
        }                                                                                          \
    } while (false)
