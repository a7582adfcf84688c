#include "bench/baselines/embree/embree_surface.h"

#include <array>
#include <limits>
#include <string>

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include "engine/core/parallel_for.h"

namespace reljef::bench {
namespace {

constexpr int packet_side = 4; // pixels; a packet has 16 rays
constexpr int max_grid_side = 32767;

void set_corners(RTCGeometry shape, glm::ivec2 samples) {
    const auto cells =
        static_cast<std::size_t>(samples.x - 1) * static_cast<std::size_t>(samples.y - 1);
    auto* corner = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        shape, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4, 4 * sizeof(unsigned), cells));
    if (corner == nullptr) {
        return; // rtcGetDeviceError() says why
    }
    const auto cols = static_cast<unsigned>(samples.x);
    for (int row = 0; row + 1 < samples.y; ++row) {
        for (int col = 0; col + 1 < samples.x; ++col) {
            const unsigned first = static_cast<unsigned>(row) * cols + static_cast<unsigned>(col);
            for (const unsigned index : {first, first + 1, first + cols + 1, first + cols}) {
                *corner++ = index;
            }
        }
    }
}

void set_grid(RTCGeometry shape, glm::ivec2 samples) {
    auto* grid = static_cast<RTCGrid*>(rtcSetNewGeometryBuffer(
        shape, RTC_BUFFER_TYPE_GRID, 0, RTC_FORMAT_GRID, sizeof(RTCGrid), 1));
    if (grid != nullptr) {
        *grid = {0, static_cast<unsigned>(samples.x), static_cast<std::uint16_t>(samples.x),
                 static_cast<std::uint16_t>(samples.y)};
    }
}

void set_vertices(RTCGeometry shape, GridView<const glm::vec3> vertices) {
    auto* vertex = static_cast<float*>(rtcSetNewGeometryBuffer(
        shape, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float),
        static_cast<std::size_t>(vertices.cols()) * static_cast<std::size_t>(vertices.rows())));
    if (vertex == nullptr) {
        return;
    }
    for (int row = 0; row < vertices.rows(); ++row) {
        for (const glm::vec3& place : vertices.row(row)) {
            for (const float coordinate : {place.x, place.y, place.z}) {
                *vertex++ = coordinate;
            }
        }
    }
}

// The rays of a picture from one eye: linear in the pixel.
struct PacketRays {
    glm::vec3 eye;
    glm::dvec3 first; // the direction at the top left corner; its depth is 1
    glm::dvec3 right; // a pixel
    glm::dvec3 down;

    PacketRays(const scene::Camera& camera, glm::ivec2 size)
        : eye(camera.eye), first(scene::view_ray(camera, size, {0.0, 0.0}).direction),
          right((scene::view_ray(camera, size, {size.x, 0.0}).direction - first) /
                static_cast<double>(size.x)),
          down((scene::view_ray(camera, size, {0.0, size.y}).direction - first) /
               static_cast<double>(size.y)) {}
};

using PacketMask = std::array<int, 16>;

struct alignas(64) Packet {
    PacketMask valid{}; // -1: the pixel is in the picture
    RTCRayHit16 rays{};
};

void aim(Packet& packet, const PacketRays& rays, glm::ivec2 first, glm::ivec2 size, float near) {
    for (std::size_t i = 0; i < packet.valid.size(); ++i) {
        const int offset = static_cast<int>(i);
        const glm::ivec2 pixel = first + glm::ivec2(offset % packet_side, offset / packet_side);
        packet.valid[i] = pixel.x < size.x && pixel.y < size.y ? -1 : 0;
        const glm::vec3 direction(rays.first + (pixel.x + 0.5) * rays.right +
                                  (pixel.y + 0.5) * rays.down);
        RTCRay16& ray = packet.rays.ray;
        ray.org_x[i] = rays.eye.x;
        ray.org_y[i] = rays.eye.y;
        ray.org_z[i] = rays.eye.z;
        ray.dir_x[i] = direction.x;
        ray.dir_y[i] = direction.y;
        ray.dir_z[i] = direction.z;
        ray.tnear[i] = near;
        ray.tfar[i] = std::numeric_limits<float>::infinity();
        ray.time[i] = 0.0F;
        ray.mask[i] = ~0U;
        ray.flags[i] = 0;
        packet.rays.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    }
}

} // namespace

std::string_view to_string(EmbreeGeometry geometry) {
    return geometry == EmbreeGeometry::grid ? "grid" : "quads";
}

struct EmbreeSurface::Tree {
    struct Release {
        void operator()(RTCDevice handle) const { rtcReleaseDevice(handle); }
        void operator()(RTCScene handle) const { rtcReleaseScene(handle); }
        void operator()(RTCGeometry handle) const { rtcReleaseGeometry(handle); }
    };
    using Shape = std::unique_ptr<RTCGeometryTy, Release>;

    std::unique_ptr<RTCDeviceTy, Release> device;
    std::unique_ptr<RTCSceneTy, Release> scene;
    EmbreeGeometry geometry = EmbreeGeometry::grid;
    glm::ivec2 samples{0};
    unsigned threads = 0;

    void read(const Packet& packet, glm::ivec2 first, float eye_height, HitBuffer& hits) const {
        for (std::size_t i = 0; i < packet.valid.size(); ++i) {
            if (packet.valid[i] == 0) {
                continue;
            }
            const int offset = static_cast<int>(i);
            Hit& hit = hits(first.x + offset % packet_side, first.y + offset / packet_side);
            const float depth = packet.rays.ray.tfar[i];
            hit = packet.rays.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID
                      ? Hit{}
                      : hit_at(place_of(packet.rays.hit, i),
                               eye_height + depth * packet.rays.ray.dir_z[i], depth);
        }
    }

private:
    [[nodiscard]] glm::dvec2 place_of(const RTCHit16& hit, std::size_t i) const {
        const glm::dvec2 within(hit.u[i], hit.v[i]);
        if (geometry == EmbreeGeometry::grid) {
            return within * glm::dvec2(samples - 1);
        }
        const auto cells = static_cast<unsigned>(samples.x - 1);
        return within + glm::dvec2(hit.primID[i] % cells, hit.primID[i] / cells);
    }
};

Result<EmbreeSurface> EmbreeSurface::create(GridView<const glm::vec3> vertices,
                                            EmbreeGeometry geometry, unsigned threads) {
    const glm::ivec2 samples(vertices.cols(), vertices.rows());
    const bool is_grid = geometry == EmbreeGeometry::grid;
    if (is_grid && std::max(samples.x, samples.y) > max_grid_side) {
        return Error{fmt::format("Embree: a grid of {} x {} samples found, at most {} a side were "
                                 "expected",
                                 samples.x, samples.y, max_grid_side)};
    }
    auto tree = std::make_shared<Tree>();
    tree->device.reset(rtcNewDevice(fmt::format("threads={}", thread_count(threads)).c_str()));
    tree->geometry = geometry;
    tree->samples = samples;
    tree->threads = threads;
    RTCDevice device = tree->device.get();
    if (device != nullptr) {
        tree->scene.reset(rtcNewScene(device));
        rtcSetSceneFlags(tree->scene.get(), RTC_SCENE_FLAG_ROBUST); // no ray passes an edge
        const Tree::Shape shape(
            rtcNewGeometry(device, is_grid ? RTC_GEOMETRY_TYPE_GRID : RTC_GEOMETRY_TYPE_QUAD));
        set_vertices(shape.get(), vertices);
        is_grid ? set_grid(shape.get(), samples) : set_corners(shape.get(), samples);
        rtcCommitGeometry(shape.get());
        rtcAttachGeometry(tree->scene.get(), shape.get());
        rtcCommitScene(tree->scene.get());
    }
    if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE) {
        return Error{fmt::format("Embree: error {} while its tree was made", error)};
    }
    return EmbreeSurface(std::move(tree));
}

HitBuffer EmbreeSurface::draw_hits(const scene::Camera& camera, glm::ivec2 size) const {
    HitBuffer hits = HitBuffer::unfilled(size.x, size.y);
    const PacketRays rays(camera, size);
    const auto draw_strip = [&](int strip) {
        Packet packet;
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        for (int x = 0; x < size.x; x += packet_side) {
            const glm::ivec2 first(x, strip * packet_side);
            aim(packet, rays, first, size, static_cast<float>(camera.near));
            rtcIntersect16(packet.valid.data(), tree_->scene.get(), &context, &packet.rays);
            tree_->read(packet, first, rays.eye.z, hits);
        }
    };
    parallel_for((size.y + packet_side - 1) / packet_side, draw_strip,
                 {.threads = tree_->threads, .stop = {}, .progress = {}});
    return hits;
}

} // namespace reljef::bench
