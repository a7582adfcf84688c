#include <chrono>
#include <cmath>
#include <iterator>
#include <string>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "engine/core/atomic_file.h"
#include "engine/io/checks/lowercase.h"
#include "engine/io/formats/flight_file.h"

namespace reljef::io {
namespace {

std::string point_text(glm::dvec3 point) {
    return fmt::format("[{:.6f}, {:.6f}, {:.6f}]", point.x, point.y, point.z);
}

std::string key_text(const PathKey& key) {
    return fmt::format("[[key]]\ntime = {:.6f}\neye = {}\nlook = {}\n\n", key.time,
                       point_text(key.eye), point_text(key.target));
}

std::string key_text(const GeodeticKey& key) {
    std::string text =
        fmt::format("[[key]]\ntime = {:.6f}\nlatitude = {:.9f}\nlongitude = {:.9f}\nheight = "
                    "{:.4f}\n",
                    key.time, key.latitude, key.longitude, key.height.value_or(0.0));
    if (key.heading) {
        text += fmt::format("heading = {:.5f}\npitch = {:.5f}\n", *key.heading,
                            key.pitch.value_or(0.0));
    }
    return text + '\n';
}

std::string toml_text(const Flight& flight) {
    std::string text = "# A camera path of reljef, for --path.\n\n";
    const auto append = [&](const auto& keys) {
        for (const auto& key : keys) {
            text += key_text(key);
        }
    };
    std::visit(append, flight.keys);
    return text;
}

// Seconds since 1970 as ISO 8601 with milliseconds. Precondition: within 1970 to 9999.
std::string time_text(double seconds) {
    const auto whole = static_cast<std::time_t>(std::floor(seconds));
    const int milliseconds = static_cast<int>(std::floor(1000.0 * (seconds - std::floor(seconds))));
    return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", fmt::gmtime(whole), milliseconds);
}

std::string gpx_text(const std::vector<GeodeticKey>& keys) {
    constexpr double end_of_9999 = 253'402'300'800.0; // seconds since 1970
    std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                       "<gpx version=\"1.1\" creator=\"reljef\" "
                       "xmlns=\"http://www.topografix.com/GPX/1/1\">\n<trk><trkseg>\n";
    for (const GeodeticKey& key : keys) {
        const double longitude = std::remainder(key.longitude, 360.0);
        const double since = key.time - keys.front().time;
        fmt::format_to(std::back_inserter(text), "<trkpt lat=\"{:.9f}\" lon=\"{:.9f}\">",
                       key.latitude, longitude);
        if (key.height) {
            fmt::format_to(std::back_inserter(text), "<ele>{:.4f}</ele>", *key.height);
        }
        if (since >= 0.0 && since < end_of_9999) {
            text += "<time>" + time_text(since) + "</time>";
        }
        text += "</trkpt>\n";
    }
    return text + "</trkseg></trk>\n</gpx>\n";
}

} // namespace

Result<AtomicFile> prepare_flight(const std::filesystem::path& path, const Flight& flight) {
    const auto prepare = [&](const std::string& text) {
        return prepare_file(path, std::as_bytes(std::span(text)));
    };
    if (extension_of(path) == ".toml") {
        return prepare(toml_text(flight));
    }
    if (extension_of(path) != ".gpx") {
        return Error{fmt::format("{}: the name of a path ends in .toml or .gpx", path.string())};
    }
    const auto* const keys = std::get_if<std::vector<GeodeticKey>>(&flight.keys);
    return keys != nullptr
               ? prepare(gpx_text(*keys))
               : Error{fmt::format("{}: keys in scene metres found, places on Earth were expected",
                                   path.string())};
}

Result<void> write_flight(const std::filesystem::path& path, const Flight& flight) {
    auto file = prepare_flight(path, flight);
    return file ? file->commit() : Result<void>(file.error());
}

} // namespace reljef::io
