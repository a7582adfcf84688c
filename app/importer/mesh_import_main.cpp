#include <charconv>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include <unistd.h>

#include "engine/io/mesh/import_process.h"
#include "engine/io/mesh/mesh_import.h"

// reljef-mesh-import FILE MEGABYTES SECONDS: reads a mesh file from a stranger within limits and
// writes its parts, or an error, to standard output. reljef runs it (engine/io/mesh/mesh_file.h).

namespace {

bool write_all(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t size = ::write(STDOUT_FILENO, bytes.data(), bytes.size());
        if (size <= 0) {
            return false;
        }
        bytes = bytes.subspan(static_cast<std::size_t>(size));
    }
    return true;
}

int number_from(std::string_view text) {
    int number = 0;
    std::from_chars(text.data(), text.data() + text.size(), number);
    return number;
}

int fail(const reljef::Error& error) {
    write_all(std::as_bytes(std::span(error.message)));
    return reljef::io::import_failed;
}

int import(const std::vector<std::string_view>& arguments) {
    if (arguments.size() != 4) {
        return fail({"a file, megabytes and seconds were expected"});
    }
    const auto limited =
        reljef::io::limit_this_process(number_from(arguments[2]), number_from(arguments[3]));
    if (!limited) {
        return fail(limited.error());
    }
    const auto parts = reljef::io::import_mesh(arguments[1]);
    if (!parts) {
        return fail(parts.error());
    }
    return write_all(reljef::io::encoded_parts(*parts)) ? 0 : 1;
}

} // namespace

int main(int argc, char** argv) {
    ::_exit(import({argv, argv + argc})); // nothing is left to do, and importers leave memory
}
