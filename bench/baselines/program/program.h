#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <istream>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

/// What the programs that draw with other libraries share. C++17, as far as their headers go.
namespace reljef::bench::baseline {

/// Of such a program, see protocol.h.
struct Arguments {
    unsigned width = 0; ///< pixels
    unsigned height = 0;
    float fov = 45.0F;  ///< degrees, vertical
    unsigned side = 0;  ///< samples
    float east = 1.0F;  ///< metres between samples
    float north = 1.0F; ///< metres between samples
    std::vector<float> heights;
    std::vector<std::uint8_t> colors;
};

struct Place {
    float east = 0.0F;
    float north = 0.0F;
    float up = 0.0F;
};

struct View {
    Place eye;
    Place target;
    float near = 1.0F; ///< metres
    float far = 2.0F;
};

/// Empty if the file is too short.
template <class T> std::vector<T> read_all(const std::string& name, std::size_t count) {
    std::vector<T> values(count);
    std::ifstream file(name, std::ios::binary);
    file.read(reinterpret_cast<char*>(values.data()),
              static_cast<std::streamsize>(count * sizeof(T)));
    return file ? values : std::vector<T>();
}

inline std::optional<Arguments> arguments_of(const std::vector<std::string>& words) {
    if (words.size() != 9) {
        return std::nullopt;
    }
    Arguments arguments;
    arguments.width = static_cast<unsigned>(std::stoul(words[1]));
    arguments.height = static_cast<unsigned>(std::stoul(words[2]));
    arguments.fov = std::stof(words[3]);
    arguments.side = static_cast<unsigned>(std::stoul(words[4]));
    arguments.east = std::stof(words[5]);
    arguments.north = std::stof(words[6]);
    const std::size_t samples = std::size_t{arguments.side} * arguments.side;
    arguments.heights = read_all<float>(words[7], samples);
    arguments.colors = read_all<std::uint8_t>(words[8], 3 * samples);
    if (arguments.heights.empty() || arguments.colors.empty()) {
        return std::nullopt;
    }
    return arguments;
}

inline std::istream& operator>>(std::istream& words, Place& place) {
    return words >> place.east >> place.north >> place.up;
}

inline std::istream& operator>>(std::istream& words, View& view) {
    return words >> view.eye >> view.target >> view.near >> view.far;
}

/// Writes a picture of numbers. False if it cannot.
inline bool write_floats(const std::string& name, const std::vector<float>& numbers) {
    std::ofstream file(name, std::ios::binary);
    file.write(reinterpret_cast<const char*>(numbers.data()),
               static_cast<std::streamsize>(numbers.size() * sizeof(float)));
    return static_cast<bool>(file);
}

/// The program's main(): `Renderer` is made of the arguments, says is_open(), and answers a
/// command and the rest of its line. `library`: its name, for errors.
template <class Renderer>
int answer_lines(const std::vector<std::string>& words, const std::string& library) {
    auto arguments = arguments_of(words);
    if (!arguments) {
        std::cout << "failed eight arguments and the files they name were expected" << std::endl;
        return EXIT_FAILURE;
    }
    Renderer renderer(std::move(*arguments));
    if (!renderer.is_open()) {
        std::cout << "failed " << library << " opens no window here" << std::endl;
        return EXIT_FAILURE;
    }
    std::cout << "ok" << std::endl;
    for (std::string line; std::getline(std::cin, line) && line != "quit";) {
        std::istringstream rest(line);
        std::string command;
        rest >> command;
        std::cout << renderer.answer(command, rest) << std::endl;
    }
    return EXIT_SUCCESS;
}

} // namespace reljef::bench::baseline
