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

/// GDALProgressFunc: false after a stop request.
int continues_reading(double fraction, const char* message, void* data);

} // namespace reljef::io
