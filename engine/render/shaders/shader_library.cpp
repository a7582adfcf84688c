#include "engine/render/shaders/shader_library.h"

#include <algorithm>
#include <array>
#include <set>

#include <fmt/format.h>

#include "engine/core/atomic_file.h"
#include "engine/render/shaders/frame_block.h"

namespace reljef::render {
namespace {

constexpr std::array kinds{
    std::pair{ShaderKind::terrain, std::string_view("terrain/terrain")},
    std::pair{ShaderKind::relief, std::string_view("relief/relief")},
    std::pair{ShaderKind::beams, std::string_view("relief/beams")},
    std::pair{ShaderKind::mesh, std::string_view("mesh/mesh")},
    std::pair{ShaderKind::textured_mesh, std::string_view("mesh/textured_mesh")},
    std::pair{ShaderKind::relief_mesh, std::string_view("mesh/relief_mesh")},
    std::pair{ShaderKind::relief_hull, std::string_view("mesh/relief_hull")},
    std::pair{ShaderKind::textured_terrain, std::string_view("terrain/textured_terrain")},
    std::pair{ShaderKind::relief_terrain, std::string_view("terrain/relief_terrain")},
    std::pair{ShaderKind::sky, std::string_view("frame/sky")},
    std::pair{ShaderKind::average, std::string_view("frame/average")}};
constexpr std::array features_by_name{
    std::pair{feature_lit, std::string_view("LIT")},
    std::pair{feature_fog, std::string_view("FOG")},
    std::pair{feature_hit, std::string_view("HIT")},
    std::pair{feature_exact, std::string_view("EXACT")},
    std::pair{feature_parallax, std::string_view("PARALLAX")},
    std::pair{feature_bisect, std::string_view("BISECT")},
    std::pair{feature_secant, std::string_view("SECANT")},
    std::pair{feature_limited, std::string_view("LIMITED")},
    std::pair{feature_iterated, std::string_view("ITERATED")},
    std::pair{feature_view_steps, std::string_view("VIEW_STEPS")},
    std::pair{feature_fade, std::string_view("FADE")},
    std::pair{feature_hard_shadow, std::string_view("HARD_SHADOW")},
    std::pair{feature_soft_shadow, std::string_view("SOFT_SHADOW")},
    std::pair{feature_smooth_edges, std::string_view("SMOOTH_EDGES")},
    std::pair{feature_write_depth, std::string_view("WRITE_DEPTH")},
    std::pair{feature_warped, std::string_view("WARPED")},
    std::pair{feature_cone, std::string_view("CONE")},
    std::pair{feature_normal_map, std::string_view("NORMAL_MAP")},
    std::pair{feature_bump, std::string_view("BUMP")},
    std::pair{feature_emboss, std::string_view("EMBOSS")},
    std::pair{feature_wrap, std::string_view("WRAP")},
    std::pair{feature_beams, std::string_view("BEAMS")},
    std::pair{feature_layers, std::string_view("LAYERS")},
    std::pair{feature_multisampled, std::string_view("MULTISAMPLED")}};

std::string_view name_of(ShaderKind kind) {
    const auto* const found = std::find_if(kinds.begin(), kinds.end(),
                                           [&](const auto& entry) { return entry.first == kind; });
    return found->second;
}

std::string header_of(std::uint32_t features) {
    std::string header = "#version 450 core\n";
    for (const auto& [feature, name] : features_by_name) {
        if ((features & feature) != 0) {
            header += fmt::format("#define {}\n", name);
        }
    }
    return header;
}

// Joins a shader file and what it includes into one text that still knows its files' lines.
class Joiner {
public:
    explicit Joiner(const std::filesystem::path& folder) : folder_(folder) {}

    Result<gl::StageSource> join(gl::Stage stage, const std::string& name, std::string header) {
        source_ = {stage, name, std::move(header), {}};
        if (auto appended = append(name, 0, 0); !appended) {
            return appended.error();
        }
        return std::move(source_);
    }

private:
    static constexpr int deepest_include = 8;

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
        if (depth > deepest_include) {
            return Error{
                fmt::format("shader {}: included more than {} deep", name, deepest_include)};
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
            source_.included.emplace_back(included);
            if (auto appended = append(included, source_.included.size(), depth + 1); !appended) {
                return appended.error();
            }
            source_.text += fmt::format("#line {} {}\n", line_number + 1, number);
        }
        return {};
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
    gl::StageSource source_;
};

// Whether the program reads its blocks as they are written.
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

Result<gl::Program> compile(ShaderVariant variant, const std::filesystem::path& folder) {
    const std::string name(name_of(variant.kind));
    const std::string header = header_of(variant.features);
    auto vertex = Joiner(folder).join(gl::Stage::vertex, name + ".vert", header);
    if (!vertex) {
        return vertex.error();
    }
    auto fragment = Joiner(folder).join(gl::Stage::fragment, name + ".frag", header);
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

} // namespace

namespace {

// One way to search, with what belongs to it.
std::uint32_t search_of(std::uint32_t features) {
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
    const std::uint32_t narrowing =
        (features & feature_bisect) != 0 ? feature_bisect : features & feature_secant;
    return narrowing | (features & feature_view_steps);
}

// What a relief with that search does beside.
std::uint32_t options_of(std::uint32_t features, std::uint32_t search) {
    std::uint32_t options = features & (feature_fade | feature_write_depth);
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

// Beams follow rays as they are, from where their technique may begin anywhere.
std::uint32_t beams_of(std::uint32_t features, std::uint32_t search) {
    const bool anywhere =
        search == feature_exact || search == feature_cone || search == feature_secant;
    return anywhere && (features & feature_fade) == 0 ? features & feature_beams : 0U;
}

// One way to be lit by heights.
std::uint32_t look_of(std::uint32_t features) {
    for (const std::uint32_t look : {feature_normal_map, feature_bump, feature_emboss}) {
        if ((features & look) != 0) {
            return look;
        }
    }
    return 0U;
}

// Whatever may mean something to a kind, alone or with others.
std::uint32_t features_that_mean_something(ShaderKind kind) {
    constexpr std::uint32_t any = feature_lit | feature_fog | feature_hit;
    constexpr std::uint32_t search = feature_exact | feature_parallax | feature_bisect |
                                     feature_secant | feature_limited | feature_iterated |
                                     feature_view_steps | feature_cone;
    constexpr std::uint32_t relief = search | feature_fade | feature_hard_shadow |
                                     feature_soft_shadow | feature_smooth_edges |
                                     feature_write_depth;
    switch (kind) {
    case ShaderKind::terrain:
        return any | feature_warped | feature_multisampled;
    case ShaderKind::mesh:
        return any | feature_multisampled;
    case ShaderKind::relief:
        return any | relief | feature_beams | feature_multisampled;
    case ShaderKind::relief_mesh:
        return any | relief | feature_layers | feature_wrap | feature_multisampled;
    case ShaderKind::textured_mesh:
        return any | feature_normal_map | feature_bump | feature_emboss | feature_wrap |
               feature_warped | feature_multisampled;
    case ShaderKind::textured_terrain:
        return any | feature_normal_map | feature_bump | feature_emboss | feature_multisampled;
    case ShaderKind::relief_hull:
        return any | search | feature_hard_shadow | feature_soft_shadow | feature_wrap |
               feature_multisampled;
    case ShaderKind::relief_terrain:
        return any | search | feature_hard_shadow | feature_soft_shadow | feature_multisampled;
    default:
        return any;
    }
}

// What a kind of shader has beside light, fog and hit.
std::uint32_t own_features(ShaderVariant variant) {
    const bool is_hit = (variant.features & feature_hit) != 0;
    const bool is_lit = (variant.features & feature_lit) != 0;
    const std::uint32_t wrap = variant.features & feature_wrap;
    const std::uint32_t look = is_lit ? look_of(variant.features) : 0U;
    constexpr std::uint32_t shadows = feature_hard_shadow | feature_soft_shadow;
    const bool on_mesh = variant.kind == ShaderKind::relief_mesh;
    const std::uint32_t foreign = (on_mesh ? 0U : feature_layers) |
                                  (variant.kind == ShaderKind::relief_hull ? feature_parallax : 0U);
    const std::uint32_t search = search_of(variant.features & ~foreign);
    switch (variant.kind) {
    case ShaderKind::terrain:
        return variant.features & feature_warped;
    case ShaderKind::relief:
        return search | options_of(variant.features, search) | beams_of(variant.features, search);
    case ShaderKind::relief_mesh:
        return search | options_of(variant.features, search) | wrap;
    case ShaderKind::textured_mesh:
        return (variant.features & feature_warped) | (is_hit ? wrap : look);
    case ShaderKind::textured_terrain:
        return look;
    case ShaderKind::relief_hull:
        return search | (options_of(variant.features, search) & (shadows | feature_lit)) | wrap;
    case ShaderKind::relief_terrain:
        return search | (options_of(variant.features, search) & shadows);
    default:
        return 0U;
    }
}

// Whether its values are taken elsewhere than in the middle of a pixel.
bool is_multisampled(ShaderVariant variant) {
    const bool knows = variant.kind != ShaderKind::beams && variant.kind != ShaderKind::sky &&
                       variant.kind != ShaderKind::average;
    return knows && (variant.features & feature_hit) == 0 &&
           (variant.features & feature_multisampled) != 0;
}

bool has_ground(ShaderKind kind) {
    return kind == ShaderKind::textured_terrain || kind == ShaderKind::relief_terrain;
}

// Lit per pixel.
bool has_own_light(ShaderKind kind) {
    return kind == ShaderKind::mesh || kind == ShaderKind::textured_mesh ||
           kind == ShaderKind::relief_mesh || kind == ShaderKind::relief_hull || has_ground(kind);
}

} // namespace

bool searches_for_surface(ShaderKind kind) {
    return kind == ShaderKind::relief || kind == ShaderKind::relief_mesh ||
           kind == ShaderKind::relief_hull || kind == ShaderKind::relief_terrain;
}

ShaderVariant without_meaningless(ShaderVariant variant) {
    variant.features &= ~(has_ground(variant.kind) ? feature_hit : 0U);
    const std::uint32_t own =
        own_features(variant) | (is_multisampled(variant) ? feature_multisampled : 0U);
    variant.features &= feature_lit | feature_fog | feature_hit;
    if (variant.kind == ShaderKind::beams || variant.kind == ShaderKind::average) {
        return {variant.kind, 0U};
    }
    if (variant.kind == ShaderKind::sky) {
        variant.features &= feature_lit;
    } else if ((variant.features & feature_hit) != 0) {
        variant.features = feature_hit;
    } else if (!has_own_light(variant.kind)) {
        variant.features &= ~feature_lit; // a terrain's light is in its map
    }
    variant.features |= own;
    return variant;
}

std::vector<ShaderVariant> all_variants() {
    std::set<ShaderVariant> variants;
    for (const auto& [kind, name] : kinds) {
        const std::uint32_t all = features_that_mean_something(kind);
        std::uint32_t features = all;
        variants.insert(without_meaningless({kind, features}));
        while (features != 0) {
            features = (features - 1) & all; // the next subset
            variants.insert(without_meaningless({kind, features}));
        }
    }
    return {variants.begin(), variants.end()};
}

Result<gl::Program*> ShaderLibrary::program(ShaderVariant variant) {
    variant = without_meaningless(variant);
    const auto found = programs_.find(variant);
    if (found != programs_.end()) {
        return &found->second;
    }
    auto program = compile(variant, folder_);
    if (!program) {
        return program.error();
    }
    return &programs_.emplace(variant, std::move(*program)).first->second;
}

} // namespace reljef::render
