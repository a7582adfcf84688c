#include "app/objects/surface_shader_option.h"

#include <cmath>
#include <string_view>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/cli/parsed_option.h"
#include "app/objects/assignments.h"

namespace reljef::app {
namespace {

constexpr const char* shader_form = "FILE[:NAME=NUMBERS,...]";

Result<std::vector<double>> numbers_of(const Assignment& assignment) {
    constexpr std::size_t max_numbers = 4;
    std::vector<double> numbers;
    std::string_view rest = assignment.value;
    for (bool is_last = false; !is_last;) {
        const std::size_t comma = rest.find(',');
        is_last = comma == std::string_view::npos;
        const auto number = cli::number_from<double>(rest.substr(0, comma));
        if (!number || !(std::abs(*number) <= io::max_shader_constant) ||
            numbers.size() == max_numbers) {
            return Error{fmt::format("--surface-shader: {}: '{}' found, 1 to {} numbers of at most "
                                     "{} were expected",
                                     assignment.key, assignment.value, max_numbers,
                                     io::max_shader_constant)};
        }
        numbers.push_back(*number);
        rest = is_last ? rest : rest.substr(comma + 1);
    }
    return numbers;
}

// Where the constants begin: at the last colon before the first '=', for files with colons.
std::size_t end_of_file(const std::string& text) {
    const std::size_t equals = text.find('=');
    return equals == std::string::npos ? equals : text.rfind(':', equals);
}

} // namespace

Result<io::SurfaceShaderDescription> parse_surface_shader(const std::string& text) {
    const std::size_t colon = end_of_file(text);
    io::SurfaceShaderDescription shader;
    shader.file = text.substr(0, colon);
    if (shader.file.empty()) {
        return Error{
            fmt::format("--surface-shader: '{}' found, {} was expected", text, shader_form)};
    }
    if (colon == std::string::npos) {
        return shader;
    }
    const auto assignments = assignments_of(text.substr(colon + 1), "--surface-shader");
    if (!assignments) {
        return assignments.error();
    }
    for (const Assignment& assignment : *assignments) {
        const auto numbers = numbers_of(assignment);
        if (!numbers) {
            return numbers.error();
        }
        shader.constants[assignment.key] = *numbers;
    }
    return shader;
}

std::string to_text(const io::SurfaceShaderDescription& shader) {
    std::string text = shader.file.string();
    const char* separator = ":";
    for (const auto& [name, values] : shader.constants) {
        text += fmt::format("{}{}={}", separator, name, fmt::join(values, ","));
        separator = ",";
    }
    return text;
}

void add_surface_shader_option(CLI::App& command,
                               std::optional<io::SurfaceShaderDescription>& shader) {
    cli::add_parsed(
        command, "--surface-shader", shader,
        [](const std::string& text) -> Result<std::optional<io::SurfaceShaderDescription>> {
            auto parsed = parse_surface_shader(text);
            return parsed ? Result<std::optional<io::SurfaceShaderDescription>>(std::move(*parsed))
                          : parsed.error();
        },
        "GLSL file with vec3 surface_color(Surface surface), which changes the light that the "
        "terrain, or each model of the gallery, reflects; with values for its uniforms of one to "
        "four numbers. OpenGL only; hits stay. Example: --surface-shader "
        "snow.glsl:snow_line=2500,tint=1,0.9,0.8",
        shader_form);
}

} // namespace reljef::app
