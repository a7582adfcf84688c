#include "engine/render/shaders/shader_library.h"

#include <algorithm>
#include <array>
#include <bit>

#include <fmt/format.h>

#include "engine/core/atomic_file.h"
#include "engine/core/check.h"
#include "engine/render/shaders/frame_block.h"

namespace reljef::render {
namespace {

// By ShaderKind.
constexpr std::array<std::string_view, 12> file_names{
    "terrain/terrain",          "relief/relief",          "relief/beams",     "mesh/mesh",
    "mesh/textured_mesh",       "mesh/relief_mesh",       "mesh/relief_hull", "mesh/sun_depth",
    "terrain/textured_terrain", "terrain/relief_terrain", "frame/sky",        "frame/average"};
// By the bits of ShaderFeatures.
constexpr std::array<std::string_view, 36> feature_names{
    "LIT",         "FOG",          "HIT",          "EXACT",       "PARALLAX",     "BISECT",
    "SECANT",      "LIMITED",      "ITERATED",     "VIEW_STEPS",  "FADE",         "HARD_SHADOW",
    "SOFT_SHADOW", "SMOOTH_EDGES", "WRITE_DEPTH",  "WARPED",      "CONE",         "NORMAL_MAP",
    "BUMP",        "EMBOSS",       "WRAP",         "BEAMS",       "LAYERS",       "MULTISAMPLED",
    "STREAMED",    "CURVED",       "COUNT",        "SLIVER",      "CORNER_DEPTH", "OVERLAY",
    "FACADES",     "POINT_LIGHTS", "MESH_SHADOWS", "SKY_PICTURE", "QUARTIC",      "DEGREES"};
static_assert(std::bit_width(feature_degrees) == feature_names.size());

std::string header_of(ShaderFeatures features) {
    std::string header = "#version 450 core\n";
    for (std::size_t bit = 0; bit < feature_names.size(); ++bit) {
        if ((features >> bit & 1U) != 0) {
            header += fmt::format("#define {}\n", feature_names[bit]);
        }
    }
    return header;
}

// Joins a shader file and its includes into one text with `#line` directives.
class Joiner {
public:
    Joiner(const std::filesystem::path& folder, const scene::SurfaceShader* surface)
        : folder_(folder), surface_(surface) {}

    Result<gl::StageSource> join(gl::Stage stage, const std::string& name, std::string header) {
        source_ = {stage, name, std::move(header), {}};
        if (auto appended = append(name, 0, 0); !appended) {
            return appended.error();
        }
        return std::move(source_);
    }

private:
    static constexpr int max_include_depth = 8;
    static constexpr std::string_view surface_include = "surface_shader";

    [[nodiscard]] Result<std::string> text_of(const std::string& name) const {
        std::error_code ignored;
        if (!folder_.empty() && std::filesystem::exists(folder_ / name, ignored)) {
            return read_text_file(folder_ / name);
        }
        const auto shaders = embedded_shaders();
        const auto found = std::find_if(shaders.begin(), shaders.end(),
                                        [&](const EmbeddedShader& s) { return s.name == name; });
        if (found == shaders.end()) {
            return Error{fmt::format("shader {}: there is no such file", name)};
        }
        return std::string(found->text);
    }

    Result<void> append(const std::string& name, std::size_t number, int depth) {
        if (depth > max_include_depth) {
            return Error{
                fmt::format("shader {}: included more than {} deep", name, max_include_depth)};
        }
        const auto text = text_of(name);
        if (!text) {
            return text.error();
        }
        source_.text += fmt::format("#line 1 {}\n", number);
        std::size_t line_number = 0;
        for (std::size_t at = 0; at < text->size();) {
            const std::size_t end = std::min(text->find('\n', at), text->size());
            const std::string line = text->substr(at, end - at);
            at = end + 1;
            ++line_number;
            const auto included = included_file(line);
            if (included.empty()) {
                source_.text += line + '\n';
                continue;
            }
            if (included == surface_include) {
                append_surface();
                source_.text += fmt::format("#line {} {}\n", line_number + 1, number);
                continue;
            }
            source_.included.emplace_back(included);
            if (auto appended = append(included, source_.included.size(), depth + 1); !appended) {
                return appended.error();
            }
            source_.text += fmt::format("#line {} {}\n", line_number + 1, number);
        }
        return {};
    }

    // As it is: files that it names are not included.
    void append_surface() {
        if (surface_ != nullptr) {
            source_.included.push_back(surface_->name());
            source_.text +=
                fmt::format("#line 1 {}\n{}\n", source_.included.size(), surface_->text());
        }
    }

    // The file that a line `#include "file"` names; empty for any other line.
    static std::string included_file(const std::string& line) {
        constexpr std::string_view start = "#include \"";
        if (line.rfind(start, 0) != 0) {
            return {};
        }
        return line.substr(start.size(), line.find('"', start.size()) - start.size());
    }

    const std::filesystem::path& folder_;
    const scene::SurfaceShader* surface_; // null: none
    gl::StageSource source_;
};

// Compares the program's blocks with the C++ structs.
Result<void> check_blocks(const gl::Program& program, std::string_view name) {
    for (const BlockLayout& block : block_layouts) {
        const int size = program.block_size(block.name);
        if (size != 0 && static_cast<std::size_t>(size) != block.size) {
            return Error{fmt::format("shader {}: uniform block {} of {} bytes found, {} were "
                                     "expected",
                                     name, block.name, size, block.size)};
        }
    }
    return {};
}

Result<gl::Program> compile(const ShaderVariant& variant, const std::filesystem::path& folder) {
    const std::string name(file_names[static_cast<std::size_t>(variant.kind)]);
    const std::string header =
        header_of(variant.features) + (variant.surface ? "#define SURFACE_SHADER\n" : "");
    auto vertex = Joiner(folder, nullptr).join(gl::Stage::vertex, name + ".vert", header);
    if (!vertex) {
        return vertex.error();
    }
    auto fragment =
        Joiner(folder, variant.surface.get()).join(gl::Stage::fragment, name + ".frag", header);
    if (!fragment) {
        return fragment.error();
    }
    const std::array stages{std::move(*vertex), std::move(*fragment)};
    auto program = gl::Program::create(stages);
    if (!program) {
        return program;
    }
    if (auto good = check_blocks(*program, name); !good) {
        return good.error();
    }
    return program;
}

// Compiles it by itself: drivers name its file and lines then (Mesa loses them in joined texts).
Result<void> check_surface(const scene::SurfaceShader& surface) {
    const auto shaders = embedded_shaders();
    const auto declared = std::find_if(shaders.begin(), shaders.end(), [](const auto& shader) {
        return shader.name == "material/surface.glsl";
    });
    check(declared != shaders.end(), "the declaration of Surface was expected");
    constexpr std::string_view call =
        "void main() {\n    vec3 zero = vec3(0.0);\n"
        "    vec3 color = surface_color(Surface(zero, zero, zero, zero, zero));\n}\n";
    return gl::Program::check({gl::Stage::fragment,
                               surface.name(),
                               fmt::format("{}{}#line 1 0\n{}\n#line 1 1\n{}", header_of(0),
                                           declared->text, surface.text(), call),
                               {"its call as vec3 surface_color(Surface)"}});
}

// One search method with its modifiers.
ShaderFeatures search_of(ShaderFeatures features) {
    if ((features & feature_exact) != 0) {
        return feature_exact;
    }
    if ((features & feature_cone) != 0) {
        return feature_cone;
    }
    if ((features & feature_layers) != 0) {
        return feature_layers;
    }
    if ((features & feature_parallax) != 0) {
        return features & (feature_parallax | feature_limited | feature_iterated);
    }
    const ShaderFeatures narrowing =
        (features & feature_bisect) != 0 ? feature_bisect : features & feature_secant;
    return narrowing | (features & feature_view_steps);
}

ShaderFeatures options_of(ShaderFeatures features, ShaderFeatures search) {
    ShaderFeatures options = features & (feature_fade | feature_write_depth);
    const bool follows_rays = (search & feature_parallax) == 0;
    if (follows_rays && (features & feature_hit) == 0) {
        options |= search == feature_layers ? 0U : features & feature_smooth_edges;
        const bool hard = (features & feature_hard_shadow) != 0;
        const auto shadow = hard ? feature_hard_shadow : features & feature_soft_shadow;
        if (shadow != 0 && (features & feature_lit) != 0) {
            options |= shadow | feature_lit;
        }
    }
    return options;
}

// Only techniques that may begin anywhere on their rays have beams.
ShaderFeatures beams_of(ShaderFeatures features, ShaderFeatures search) {
    const bool anywhere =
        search == feature_exact || search == feature_cone || search == feature_secant;
    return anywhere && (features & (feature_fade | feature_degrees)) == 0 ? features & feature_beams
                                                                          : 0U;
}

// Of a terrain's search space.
ShaderFeatures space_features_of(ShaderFeatures features) {
    ShaderFeatures bent = features & feature_curved;
    if (bent != 0) {
        bent |= features & ((features & feature_degrees) != 0 ? feature_degrees : feature_quartic);
    }
    return (features & feature_streamed) | bent;
}

ShaderFeatures lighting_of(ShaderFeatures features) {
    for (const ShaderFeatures method : {feature_normal_map, feature_bump, feature_emboss}) {
        if ((features & method) != 0) {
            return method;
        }
    }
    return 0U;
}

ShaderFeatures sliver_of(ShaderFeatures features) {
    return (features & feature_sliver) != 0 ? features & (feature_sliver | feature_corner_depth)
                                            : 0U;
}

ShaderFeatures overlay_of(ShaderFeatures features) {
    const bool has_none = (features & feature_hit) != 0 || (features & feature_overlay) == 0;
    return has_none ? 0U : features & (feature_overlay | feature_facades);
}

ShaderFeatures points_of(ShaderFeatures features) {
    return (features & feature_hit) != 0 ? 0U : features & feature_point_lights;
}

// Of a mesh's own colours.
ShaderFeatures mesh_shadows_of(ShaderFeatures features) {
    const bool is_lit = (features & feature_lit) != 0 && (features & feature_hit) == 0;
    return is_lit ? features & feature_mesh_shadows : 0U;
}

// Of a terrain's triangles, whose light is in maps.
ShaderFeatures mesh_shadows_on_triangles(ShaderFeatures features) {
    constexpr ShaderFeatures others = feature_hit | feature_counting;
    return (features & others) == 0 ? features & feature_mesh_shadows : 0U;
}

// Only a relief whose own shadows are rays has the sun's light apart.
ShaderFeatures mesh_shadows_on_relief(ShaderFeatures features, ShaderFeatures options) {
    const bool has_rays = (options & (feature_hard_shadow | feature_soft_shadow)) != 0;
    return has_rays ? features & feature_mesh_shadows : 0U;
}

// Features of a kind of shader except light, fog and hit.
ShaderFeatures own_features(const ShaderVariant& variant) {
    const bool is_hit = (variant.features & feature_hit) != 0;
    const bool is_lit = (variant.features & feature_lit) != 0;
    const ShaderFeatures wrap = variant.features & feature_wrap;
    const ShaderFeatures lighting = is_lit ? lighting_of(variant.features) : 0U;
    const ShaderFeatures points = points_of(variant.features);
    constexpr ShaderFeatures shadows = feature_hard_shadow | feature_soft_shadow;
    const bool on_mesh = variant.kind == ShaderKind::relief_mesh;
    const ShaderFeatures foreign =
        (on_mesh ? 0U : feature_layers) |
        (variant.kind == ShaderKind::relief_hull ? feature_parallax : 0U);
    const ShaderFeatures search = search_of(variant.features & ~foreign);
    switch (variant.kind) {
    case ShaderKind::terrain:
        return (variant.features & feature_warped) != 0
                   ? feature_warped
                   : sliver_of(variant.features) | overlay_of(variant.features) | points |
                         mesh_shadows_on_triangles(variant.features);
    case ShaderKind::relief:
        return search | options_of(variant.features, search) | beams_of(variant.features, search) |
               overlay_of(variant.features) | points |
               mesh_shadows_on_relief(variant.features, options_of(variant.features, search)) |
               space_features_of(variant.features);
    case ShaderKind::beams:
        return space_features_of(variant.features & ~feature_degrees);
    case ShaderKind::relief_mesh:
        return search | options_of(variant.features, search) | wrap | points |
               mesh_shadows_of(variant.features);
    case ShaderKind::textured_mesh:
        return (variant.features & feature_warped) | (is_hit ? wrap : lighting) | points |
               mesh_shadows_of(variant.features);
    case ShaderKind::textured_terrain:
        return lighting | sliver_of(variant.features) | points | mesh_shadows_of(variant.features);
    case ShaderKind::relief_hull:
        return search | (options_of(variant.features, search) & (shadows | feature_lit)) | wrap |
               points;
    case ShaderKind::relief_terrain:
        return search | (options_of(variant.features, search) & shadows) |
               sliver_of(variant.features) | points | mesh_shadows_of(variant.features);
    case ShaderKind::mesh:
        return points | mesh_shadows_of(variant.features);
    case ShaderKind::sky:
        return variant.features & feature_sky_picture;
    default:
        return 0U;
    }
}

// Whether it draws parts of a picture that may have several samples per pixel.
bool has_samples(ShaderKind kind) {
    return kind != ShaderKind::beams && kind != ShaderKind::sky && kind != ShaderKind::average &&
           kind != ShaderKind::sun_depth;
}

bool is_multisampled(const ShaderVariant& variant) {
    return has_samples(variant.kind) && (variant.features & feature_hit) == 0 &&
           (variant.features & feature_multisampled) != 0;
}

bool has_ground(ShaderKind kind) {
    return kind == ShaderKind::textured_terrain || kind == ShaderKind::relief_terrain;
}

// Terrains and their reliefs have the light in their maps.
bool is_lit_per_pixel(ShaderKind kind) {
    return kind != ShaderKind::terrain && kind != ShaderKind::relief;
}

bool counts_work(const ShaderVariant& variant) {
    const bool is_terrain = variant.kind == ShaderKind::terrain ||
                            variant.kind == ShaderKind::relief || variant.kind == ShaderKind::beams;
    return is_terrain && (variant.features & feature_hit) == 0 &&
           (variant.features & feature_counting) != 0;
}

ShaderVariant counting_variant(ShaderVariant variant) {
    constexpr ShaderFeatures looks = feature_counting | feature_fog | feature_write_depth |
                                     feature_multisampled | feature_overlay | feature_facades |
                                     feature_point_lights | feature_mesh_shadows;
    variant = canonical_variant({variant.kind, variant.features & ~looks});
    variant.features |= feature_counting;
    return variant;
}

} // namespace

bool searches_for_surface(ShaderKind kind) {
    return kind == ShaderKind::relief || kind == ShaderKind::relief_mesh ||
           kind == ShaderKind::relief_hull || kind == ShaderKind::relief_terrain;
}

ShaderVariant canonical_variant(ShaderVariant variant) {
    if (counts_work(variant)) {
        return counting_variant(variant);
    }
    variant.features &= ~(has_ground(variant.kind) ? feature_hit : 0U);
    const ShaderFeatures own =
        own_features(variant) | (is_multisampled(variant) ? feature_multisampled : 0U);
    variant.features &= feature_lit | feature_fog | feature_hit;
    if (variant.kind == ShaderKind::beams || variant.kind == ShaderKind::average ||
        variant.kind == ShaderKind::sun_depth) {
        return {variant.kind, own};
    }
    if (variant.kind == ShaderKind::sky) {
        variant.features &= feature_lit | feature_fog;
    } else if ((variant.features & feature_hit) != 0) {
        variant.features = feature_hit;
    } else if (!is_lit_per_pixel(variant.kind)) {
        variant.features &= ~feature_lit;
    }
    variant.features |= own;
    if (variant.kind == ShaderKind::sky || (variant.features & feature_hit) != 0) {
        variant.surface = nullptr;
        variant.constants.clear();
    }
    return variant;
}

Result<gl::Program*> ShaderLibrary::program(ShaderVariant variant) {
    variant = canonical_variant(variant);
    const auto found = programs_.find(variant);
    if (found != programs_.end()) {
        return &found->second;
    }
    if (variant.surface) {
        if (auto good = check_surface(*variant.surface); !good) {
            return good.error();
        }
    }
    auto program = compile(variant, folder_);
    if (!program && variant.surface) {
        return Error{fmt::format("{}: does not fit the shaders of the technique: {}",
                                 variant.surface->name(), program.error().message)};
    }
    if (!program) {
        return program.error();
    }
    return &programs_.emplace(variant, std::move(*program)).first->second;
}

} // namespace reljef::render
