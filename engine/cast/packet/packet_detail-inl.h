// A detail texture over the ground that a packet of rays hits, as shaders/terrain/ground_color.glsl
// shows it. Included once for each instruction set.
#if defined(RELJEF_PACKET_DETAIL_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RELJEF_PACKET_DETAIL_INL_H
#undef RELJEF_PACKET_DETAIL_INL_H
#else
#define RELJEF_PACKET_DETAIL_INL_H
#endif

#include <cmath>

#include "engine/cast/packet/packet_relief-inl.h"

HWY_BEFORE_NAMESPACE();
namespace reljef::cast::HWY_NAMESPACE {

// From a pixel to its neighbours.
struct CopyChanges {
    CopyPlace right;
    CopyPlace down;
};

// Adds the bilinear values of each lane's level, times their weights.
template <class Encoding>
HWY_INLINE void add_repeated_level(const RepeatedMap& map, const CopyPlace& place, Ints level,
                                   Floats weight, Color& sum) {
    const auto side = [&](int size) HWY_ATTR { return hn::Max(hn::Shr(all(size), level), all(1)); };
    const Ints cols = side(map.size.x);
    const Ints rows = side(map.size.y);
    // From the texel beside the first one.
    const auto texel = [](Floats copies, Ints texels) HWY_ATTR {
        const Floats width = hn::ConvertTo(floats, texels);
        const Floats part = hn::Sub(copies, hn::Floor(copies));
        const Floats inside = hn::Min(hn::Max(part, hn::Zero(floats)), all(1.0F));
        return hn::MulAdd(inside, width, all(0.5F));
    };
    const Floats u = texel(place.u, cols);
    const Floats v = texel(place.v, rows);
    const Ints col = truncated(u);
    const Ints row = truncated(v);
    const Ints stride = hn::Add(cols, all(2));
    const Ints index =
        hn::Add(hn::Add(hn::Mul(row, stride), col), hn::GatherIndex(ints, map.begin.data(), level));
    add_bilinear<Encoding>(map.texels,
                           {index, hn::Add(index, stride), hn::Sub(u, hn::ConvertTo(floats, col)),
                            hn::Sub(v, hn::ConvertTo(floats, row))},
                           weight, sum);
}

// Bilinear in the two levels nearest to each lane's.
template <class Encoding>
HWY_INLINE Color repeated_sum(const RepeatedMap& map, const CopyPlace& place, Floats level) {
    const Ints fine = truncated(level);
    const Floats coarse_part = hn::Sub(level, hn::ConvertTo(floats, fine));
    Color sum = all(glm::vec3(0.0F));
    add_repeated_level<Encoding>(map, place, fine, hn::Sub(all(1.0F), coarse_part), sum);
    if (!hn::AllTrue(floats, hn::Eq(coarse_part, hn::Zero(floats)))) {
        const Ints coarse = hn::Min(hn::Add(fine, all(1)), all(map.level_count - 1));
        add_repeated_level<Encoding>(map, place, coarse, coarse_part, sum);
    }
    return sum;
}

// The mip level, limited to an anisotropy of 8.
HWY_INLINE Floats level_in(const RepeatedMap& map, const CopyChanges& changes) {
    const auto squared_texels = [&](const CopyPlace& change) HWY_ATTR {
        const Floats u = hn::Mul(change.u, all(static_cast<float>(map.size.x)));
        const Floats v = hn::Mul(change.v, all(static_cast<float>(map.size.y)));
        return hn::MulAdd(u, u, hn::Mul(v, v));
    };
    const Floats right = squared_texels(changes.right);
    const Floats down = squared_texels(changes.down);
    const Floats limit = hn::Mul(all(64.0F), hn::Max(hn::Min(right, down), all(1e-12F)));
    const Floats square = hn::Max(hn::Min(hn::Max(right, down), limit), all(1.0F));
    const Floats last = all(static_cast<float>(map.level_count - 1));
    return hn::Min(hn::Max(hn::Mul(all(0.5F), log2_of(square)), hn::Zero(floats)), last);
}

// One of the axes, or its opposite.
struct SignedAxis {
    std::size_t axis;
    Floats sign;

    [[nodiscard]] HWY_INLINE Floats of(const Vectors& vector) const {
        return hn::Mul(vector[axis], sign);
    }
    // Its part in the plane across a unit vector (Blinn 1978).
    [[nodiscard]] HWY_INLINE Vectors across(const Vectors& normal) const {
        const Floats rise = of(normal);
        Vectors part{hn::Neg(hn::Mul(normal[0], rise)), hn::Neg(hn::Mul(normal[1], rise)),
                     hn::Neg(hn::Mul(normal[2], rise))};
        part[axis] = hn::Add(part[axis], sign);
        return part;
    }
};

// How a texture lies that is projected along an axis. Pictures on walls are upright and not
// mirrored.
struct Projection {
    SignedAxis u;
    SignedAxis v;
};

HWY_INLINE Projection projection_along(int axis, const Vectors& normal) {
    const Floats one = all(1.0F);
    const Floats back = all(-1.0F);
    const Floats zero = hn::Zero(floats);
    if (axis == 0) {
        return {{1, hn::IfThenElse(hn::Lt(normal[0], zero), back, one)}, {2, back}};
    }
    if (axis == 1) {
        return {{0, hn::IfThenElse(hn::Lt(normal[1], zero), one, back)}, {2, back}};
    }
    return {{0, one}, {1, back}};
}

// Shares of the axes; those that the surface faces equally are blended.
HWY_INLINE Vectors shares_of_axes(const Vectors& normal) {
    constexpr float blended = 0.15F;
    const Vectors facing{hn::Abs(normal[0]), hn::Abs(normal[1]), hn::Abs(normal[2])};
    const Floats begin = hn::Sub(hn::Max(hn::Max(facing[0], facing[1]), facing[2]), all(blended));
    Vectors shares;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        shares[axis] = hn::Max(hn::Sub(facing[axis], begin), hn::Zero(floats));
    }
    const Floats scale = hn::Div(all(1.0F), hn::Add(hn::Add(shares[0], shares[1]), shares[2]));
    return {hn::Mul(shares[0], scale), hn::Mul(shares[1], scale), hn::Mul(shares[2], scale)};
}

// Gradients of u and v in the plane that touches the surface, and its normal. On slopes the
// gradients are shorter than 1 a metre.
struct TangentSpace {
    Vectors u;
    Vectors v;
    Vectors normal;
};

// The ground at the hits, for all axes.
struct DetailGround {
    Vectors at;    // the place in copies, modulo 1
    Vectors right; // change of the place to the next pixels, metres
    Vectors down;
    Vectors to_eye;      // of any length
    Vectors normal;      // unit vectors, all of them along the local axes
    Floats height_share; // of the relief's heights; 0: none is seen
    Color albedo;
    Color sky; // light at albedo 1
    Floats sun_share;
    Vectors world_to_eye; // unit vectors
    Vectors place;        // from the eye, world metres
};

// The place whose relief is seen at a place of the surface.
HWY_INLINE CopyPlace relief_place(const DetailPaint& detail, const DetailGround& ground,
                                  const TangentSpace& space, const CopyPlace& place) {
    const DetailSearch& search = detail.search;
    const Lanes searched = hn::Gt(ground.height_share, hn::Zero(floats));
    if ((search.steps_from_above == 0 && !search.shifts) || hn::AllFalse(floats, searched)) {
        return place;
    }
    const Floats lift = hn::Mul(all(detail.lift), ground.height_share);
    const Vectors to_eye{dot(ground.to_eye, space.u), dot(ground.to_eye, space.v),
                         dot(ground.to_eye, space.normal)};
    const ReliefRay ray = relief_ray(detail, to_eye, lift, place);
    Lanes found = searched;
    SamplePlace seen;
    if (search.shifts) {
        seen = shifted_place(detail, ray, lift);
    } else {
        const Bracket bracket =
            first_step_below(detail, ray, steps_of(detail, ray, lift), searched);
        found = bracket.found;
        const Floats part = narrowed(detail, ray, bracket);
        seen = {hn::MulAdd(part, ray.to_col, ray.col), hn::MulAdd(part, ray.to_row, ray.row)};
    }
    const auto copies = [&](Floats sample, int samples) HWY_ATTR {
        return hn::Mul(hn::Add(sample, all(0.5F)), all(1.0F / static_cast<float>(samples)));
    };
    return {hn::IfThenElse(found, copies(seen.col, detail.samples.x), place.u),
            hn::IfThenElse(found, copies(seen.row, detail.samples.y), place.v)};
}

// The normal of the map, as steep as the relief is, in the world.
HWY_INLINE Vectors relief_normal(const BlockPaint& paint, const CopyPlace& place,
                                 const CopyChanges& changes, const TangentSpace& space) {
    const DetailPaint& detail = *paint.detail;
    const Color sum =
        repeated_sum<Linear>(detail.normals, place, level_in(detail.normals, changes));
    const auto lean_of = [](Floats value) HWY_ATTR {
        constexpr auto zero = static_cast<float>(normal_zero);
        return hn::MulSub(value, all(1.0F / zero), all(1.0F));
    };
    const Floats u = lean_of(sum.r);
    const Floats v = lean_of(sum.g);
    const Floats square = hn::NegMulAdd(u, u, hn::NegMulAdd(v, v, all(1.0F)));
    const Floats steeper = hn::Div(all(detail.steeper), hn::Sqrt(hn::Max(square, all(1e-4F))));
    Vectors local;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        local[axis] =
            hn::MulAdd(hn::Mul(u, steeper), space.u[axis],
                       hn::MulAdd(hn::Mul(v, steeper), space.v[axis], space.normal[axis]));
    }
    return unit_vector(turned_by(paint.world_from_normal, local));
}

// x^y, for x in [0, 1].
HWY_INLINE Floats power_of(Floats x, float y) {
    const Floats smallest = all(1e-30F);
    return exp2_of(hn::Mul(all(y), hn::Min(log2_of(hn::Max(x, smallest)), hn::Zero(floats))));
}

// `normal`: of the relief, in the world.
HWY_INLINE Color shiny_color(const BlockPaint& paint, const DetailGround& ground,
                             const Color& albedo, const Vectors& normal) {
    const DetailPaint& detail = *paint.detail;
    const Floats zero = hn::Zero(floats);
    const Vectors surface = unit_vector(turned_by(paint.world_from_normal, ground.normal));
    const auto sky_of = [&](const Vectors& of) HWY_ATTR {
        return hn::MulAdd(all(0.5F), dot(of, all_of(detail.up)), all(0.5F));
    };
    const Floats sky =
        paint.has_sun ? hn::Div(sky_of(normal), hn::Max(sky_of(surface), all(0.25F))) : all(1.0F);
    Color lit = product(albedo, scaled(ground.sky, sky));
    if (paint.has_sun) {
        // Over a degree the light of places that turn away from the sun fades.
        constexpr float steepness = 64.0F;
        const Vectors to_sun = all_of(paint.to_sun);
        const Floats facing =
            hn::Min(hn::Max(hn::Mul(all(steepness), dot(surface, to_sun)), zero), all(1.0F));
        const Floats seen = hn::Mul(facing, ground.sun_share);
        const Floats sun = hn::Mul(hn::Max(dot(normal, to_sun), zero), seen);
        const Vectors half = unit_vector({hn::Add(to_sun[0], ground.world_to_eye[0]),
                                          hn::Add(to_sun[1], ground.world_to_eye[1]),
                                          hn::Add(to_sun[2], ground.world_to_eye[2])});
        const Floats mirrored = power_of(hn::Max(dot(normal, half), zero), detail.shininess);
        const Floats shine = hn::IfThenElseZero(
            hn::Gt(sun, zero), hn::Mul(all(detail.specular), hn::Mul(seen, mirrored)));
        lit.r = hn::MulAdd(all(paint.sun.r), hn::MulAdd(albedo.r, sun, shine), lit.r);
        lit.g = hn::MulAdd(all(paint.sun.g), hn::MulAdd(albedo.g, sun, shine), lit.g);
        lit.b = hn::MulAdd(all(paint.sun.b), hn::MulAdd(albedo.b, sun, shine), lit.b);
    }
    return paint.point_lights.empty()
               ? lit
               : added(lit, product(albedo, light_of_points(paint, ground.place, normal)));
}

// The terrain's colour times the texture's deviation from its mean colour.
HWY_INLINE Color tinted(const DetailPaint& detail, const Color& albedo, const CopyPlace& place,
                        const CopyChanges& changes) {
    const Color texture =
        repeated_sum<SquareRoots>(detail.color, place, level_in(detail.color, changes));
    const glm::vec3 scale = 1.0F / (1023.0F * 1023.0F * detail.mean_color);
    const auto tint = [](Floats channel, Floats by, float scaled_by) HWY_ATTR {
        return hn::Min(hn::Mul(channel, hn::Mul(by, all(scaled_by))), all(1.0F));
    };
    return {tint(albedo.r, texture.r, scale.r), tint(albedo.g, texture.g, scale.g),
            tint(albedo.b, texture.b, scale.b)};
}

// The texture projected along an axis.
HWY_NOINLINE Color projected_color(const BlockPaint& paint, const DetailGround& ground, int axis) {
    const DetailPaint& detail = *paint.detail;
    const Projection projection = projection_along(axis, ground.normal);
    const CopyPlace place{projection.u.of(ground.at), projection.v.of(ground.at)};
    const Floats per_width = all(1.0F / detail.width);
    const auto change = [&](const Vectors& metres) HWY_ATTR {
        return CopyPlace{hn::Mul(projection.u.of(metres), per_width),
                         hn::Mul(projection.v.of(metres), per_width)};
    };
    const CopyChanges changes{change(ground.right), change(ground.down)};
    const TangentSpace space{projection.u.across(ground.normal), projection.v.across(ground.normal),
                             ground.normal};
    const CopyPlace seen = relief_place(detail, ground, space, place);
    const Color albedo = tinted(detail, ground.albedo, seen, changes);
    return shiny_color(paint, ground, albedo, relief_normal(paint, seen, changes, space));
}

// Divides the light of the ground's maps: the sun's part follows from its visible share, and the
// rest is the sky's.
HWY_INLINE void set_light(const BlockPaint& paint, const Color& lit, DetailGround& ground) {
    const Vectors surface = unit_vector(turned_by(paint.world_from_normal, ground.normal));
    const Floats facing = hn::Max(dot(surface, all_of(paint.to_sun)), hn::Zero(floats));
    const Floats sun = paint.has_sun ? hn::Mul(facing, ground.sun_share) : hn::Zero(floats);
    const auto sky_of = [&](Floats reflected, Floats albedo, float of_sun) HWY_ATTR {
        const Floats irradiance = hn::Div(reflected, hn::Max(albedo, all(1.0F / 4096.0F)));
        return hn::Max(hn::NegMulAdd(all(of_sun), sun, irradiance), hn::Zero(floats));
    };
    ground.sky = {sky_of(lit.r, ground.albedo.r, paint.sun.r),
                  sky_of(lit.g, ground.albedo.g, paint.sun.g),
                  sky_of(lit.b, ground.albedo.b, paint.sun.b)};
}

// Changes of the hits to the next pixels, in the plane that touches the surface.
HWY_INLINE void set_changes(const BlockPaint& paint, Floats depth, const Vectors& view,
                            DetailGround& ground) {
    const glm::mat3& turn = paint.detail->local_from_world;
    constexpr float flattest = 1.0F / 64.0F;
    const Floats length = hn::Sqrt(dot(view, view));
    const Floats facing = hn::Min(dot(ground.normal, view), hn::Mul(all(-flattest), length));
    const auto change = [&](glm::vec3 origin, glm::vec3 direction) HWY_ATTR {
        const glm::vec3 from = turn * origin;
        const glm::vec3 along = turn * direction;
        Vectors moved;
        for (int axis = 0; axis < 3; ++axis) {
            moved[static_cast<std::size_t>(axis)] =
                hn::MulAdd(depth, all(along[axis]), all(from[axis]));
        }
        const Floats back = hn::Div(dot(ground.normal, moved), facing);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            moved[axis] = hn::NegMulAdd(view[axis], back, moved[axis]);
        }
        return moved;
    };
    ground.right = change(paint.origin.right, paint.view.right);
    ground.down = change(paint.origin.down, paint.view.down);
}

// The looks of ground by its maps alone.
struct GroundLooks {
    Floats level; // of their mip levels
    Lanes sunny;  // the sun reaches them, if rays decide
    Color by_sun; // the light of sun and sky
    Color lit;    // with that of point lights
};

// The mip level of another map of the ground, which may have larger or smaller texels.
HWY_INLINE Floats level_on(const TilePaint& map, const TilePaint& lit, Floats level) {
    const float finer = std::log2(map.texels_per_sample.x / lit.texels_per_sample.x);
    const Floats last = all(static_cast<float>(map.level_count - 1));
    return hn::Min(hn::Max(hn::Add(level, all(finer)), hn::Zero(floats)), last);
}

HWY_INLINE Floats pixel_width(const DetailPaint& detail, Floats distance) {
    return hn::MulAdd(distance, all(detail.metres_a_pixel.y), all(detail.metres_a_pixel.x));
}

HWY_INLINE DetailGround detail_ground(const BlockJob& job, const BlockPaint& paint,
                                      const GroundPlace& place, const PacketHits& hits,
                                      const GroundLooks& looks) {
    const DetailPaint& detail = *paint.detail;
    DetailGround ground;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        ground.place[axis] = hn::IfThenElseZero(hits.found, place.from_eye[axis]);
    }
    const Vectors local = turned_by(detail.local_from_world, ground.place);
    for (int axis = 0; axis < 3; ++axis) {
        const auto index = static_cast<std::size_t>(axis);
        ground.at[index] =
            hn::MulAdd(local[index], all(1.0F / detail.width), all(detail.copies_at_eye[axis]));
    }
    const auto opposite = [](const Vectors& vector) HWY_ATTR {
        return Vectors{hn::Neg(vector[0]), hn::Neg(vector[1]), hn::Neg(vector[2])};
    };
    const Vectors view = turned_by(detail.local_from_world, place.view);
    ground.to_eye = opposite(view);
    ground.world_to_eye = unit_vector(opposite(place.view));
    const Floats level = level_on(*job.albedo, *job.paint, looks.level);
    ground.normal = unit_vector(map_normal(*job.normals, hits, level));
    ground.albedo = map_color(*job.albedo, hits, level);
    ground.sun_share = job.sun == nullptr && job.sun_share != nullptr
                           ? map_color(*job.sun_share, hits, level).r
                           : hn::IfThenElseZero(looks.sunny, all(1.0F));
    set_light(paint, looks.by_sun, ground);
    const Floats distance = hn::IfThenElseZero(hits.found, place.distance);
    const Floats pixels = hn::Div(all(detail.lift), pixel_width(detail, distance));
    ground.height_share = hn::IfThenElseZero(
        hits.found, smooth_step(detail.seen_height.x, detail.seen_height.y, pixels));
    set_changes(paint, hn::Div(distance, place.view_length), view, ground);
    return ground;
}

// How much of the texture is seen at a distance, 0 to 1.
HWY_INLINE Floats seen_share(const DetailPaint& detail, Floats distance, Lanes found) {
    const Floats pixels = hn::Div(all(detail.width), pixel_width(detail, distance));
    return hn::IfThenElseZero(found, smooth_step(detail.seen_width.x, detail.seen_width.y, pixels));
}

// The ground under its texture. Precondition: the job has the albedo and the normals of its ground.
HWY_NOINLINE Color detailed_color(const BlockJob& job, const BlockPaint& paint,
                                  const GroundPlace& place, const PacketHits& hits,
                                  const GroundLooks& looks) {
    const DetailGround ground = detail_ground(job, paint, place, hits, looks);
    const Vectors shares = shares_of_axes(ground.normal);
    Color shown = all(glm::vec3(0.0F));
    for (int axis = 0; axis < 3; ++axis) {
        const Floats of_axis = shares[static_cast<std::size_t>(axis)];
        if (!hn::AllFalse(floats, hn::And(hits.found, hn::Gt(of_axis, hn::Zero(floats))))) {
            shown = added(shown, scaled(projected_color(paint, ground, axis), of_axis));
        }
    }
    return shown;
}

} // namespace reljef::cast::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
