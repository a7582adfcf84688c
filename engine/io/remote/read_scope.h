#pragma once

#include <stop_token>

namespace reljef::io {

/// Reads of this thread end soon after `stop` is requested, also those within GDAL. Scopes may be
/// nested; each one counts. Threads that GDAL starts by itself do not see it.
class ReadScope {
public:
    explicit ReadScope(std::stop_token stop);
    ~ReadScope();
    ReadScope(const ReadScope&) = delete;
    ReadScope& operator=(const ReadScope&) = delete;

    /// Whether a stop was requested in any scope of this thread.
    static bool stop_requested();

private:
    std::stop_token stop_;
    const ReadScope* outer_;
};

/// One deadline for all requests that this thread makes for one open or one read of a window. Of
/// nested ones, the outermost counts.
class ReadDeadline {
public:
    ReadDeadline();
    ~ReadDeadline();
    ReadDeadline(const ReadDeadline&) = delete;
    ReadDeadline& operator=(const ReadDeadline&) = delete;

    /// Since the outermost began; 0 without one.
    static double seconds();

private:
    bool is_outermost_;
};

/// GDALProgressFunc: false after a stop request.
int continues_reading(double fraction, const char* message, void* data);

} // namespace reljef::io
