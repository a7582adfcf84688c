// Draws a terrain with Irrlicht for reljef-bench, see bench/baselines/program/protocol.h.
#include <array>
#include <chrono>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <GL/gl.h>
#include <irrlicht/irrlicht.h>

#include "bench/baselines/irrlicht/relief_plane.h"
#include "bench/baselines/program/program.h"

namespace {

using namespace irr;
namespace baseline = reljef::bench::baseline;

// Irrlicht's axes are east, up, north.
core::vector3df place_of(const baseline::Place& place) {
    return {place.east, place.up, place.north};
}

class Renderer {
public:
    explicit Renderer(baseline::Arguments arguments) : arguments_(std::move(arguments)) {
        SIrrlichtCreationParameters parameters;
        parameters.DriverType = video::EDT_OPENGL;
        parameters.WindowSize = {arguments_.width, arguments_.height};
        parameters.Bits = 32;
        parameters.ZBufferBits = 24;
        parameters.Vsync = false;
        parameters.LoggingLevel = ELL_ERROR;
        device_ = createDeviceEx(parameters);
        if (device_ == nullptr) {
            return;
        }
        driver_ = device_->getVideoDriver();
        scene_ = device_->getSceneManager();
        camera_ = scene_->addCameraSceneNode();
        camera_->setFOV(arguments_.fov * core::DEGTORAD);
        camera_->setAspectRatio(static_cast<f32>(arguments_.width) /
                                static_cast<f32>(arguments_.height));
        texture_ = make_texture();
    }
    Renderer(const Renderer&) = delete;
    ~Renderer() {
        if (device_ != nullptr) {
            device_->drop();
        }
    }

    [[nodiscard]] bool is_open() const { return device_ != nullptr; }

    std::string answer(const std::string& command, std::istream& words) {
        if (command == "lods") {
            s32 levels = 1;
            words >> levels;
            return build(levels) ? "ok" : "failed Irrlicht builds no terrain of these heights";
        }
        if (command == "relief") {
            return build_relief();
        }
        if (command == "samples") {
            return write_samples(words);
        }
        if (command == "view") {
            return place_eye(words);
        }
        if (command == "draw") {
            return draw();
        }
        if (command == "depth") {
            std::string name;
            std::getline(words >> std::ws, name);
            return write_depth(name);
        }
        return "failed '" + command +
               "' found, lods, relief, view, draw, depth, samples or quit was "
               "expected";
    }

private:
    video::ITexture* make_texture() {
        video::IImage* const image =
            driver_->createImage(video::ECF_R8G8B8, {arguments_.side - 1, arguments_.side - 1});
        for (u32 y = 0; y + 1 < arguments_.side; ++y) {
            for (u32 x = 0; x + 1 < arguments_.side; ++x) {
                const u8* const color = &arguments_.colors[3 * (y * arguments_.side + x)];
                image->setPixel(x, y, {255, color[0], color[1], color[2]});
            }
        }
        video::ITexture* const texture = driver_->addTexture("colors", image);
        image->drop();
        return texture;
    }

    bool build(s32 levels) {
        if (terrain_ != nullptr) {
            terrain_->remove();
        }
        const f32 half = 0.5F * static_cast<f32>(arguments_.side - 1);
        const core::vector3df spacing(arguments_.east, 1.0F, arguments_.north);
        const core::vector3df corner = spacing * core::vector3df(-half, 0.0F, -half);
        terrain_ = scene_->addTerrainSceneNode(static_cast<io::IReadFile*>(nullptr), nullptr, -1,
                                               corner, {}, spacing, {255, 255, 255, 255}, levels,
                                               scene::ETPS_17, 0, true);
        auto* const file = device_->getFileSystem()->createMemoryReadFile(
            arguments_.heights.data(), static_cast<s32>(arguments_.heights.size() * sizeof(f32)),
            "heights", false);
        const bool good =
            terrain_->loadHeightMapRAW(file, 32, true, true, static_cast<s32>(arguments_.side));
        file->drop();
        terrain_->setMaterialFlag(video::EMF_LIGHTING, false);
        terrain_->setMaterialFlag(video::EMF_TRILINEAR_FILTER, true);
        terrain_->setMaterialTexture(0, texture_);
        return good;
    }

    std::string build_relief() {
        relief_.emplace(*scene_, arguments_);
        if (!relief_->is_supported()) {
            return "failed the OpenGL driver has no shaders for Irrlicht's parallax material";
        }
        relief_->build(texture_);
        background_ = baseline::ReliefPlane::background();
        return "ok";
    }

    std::string write_samples(std::istream& words) {
        int axis = 0;
        std::string name;
        words >> axis;
        std::getline(words >> std::ws, name);
        if (!relief_ || axis < 0 || axis > 1) {
            return "failed a relief and an axis of 0 or 1 were expected";
        }
        relief_->show_places(axis);
        device_->run();
        draw_frame();
        std::vector<std::array<u8, 3>> colors(std::size_t{arguments_.width} * arguments_.height);
        glPixelStorei(GL_PACK_ALIGNMENT, 1);
        glReadPixels(0, 0, static_cast<GLsizei>(arguments_.width),
                     static_cast<GLsizei>(arguments_.height), GL_RGB, GL_UNSIGNED_BYTE,
                     colors.data());
        driver_->endScene();
        relief_->show_colors();
        std::vector<float> samples;
        samples.reserve(colors.size());
        for (const auto& color : colors) {
            samples.push_back(relief_->sample_of(color));
        }
        return baseline::write_floats(name, samples) ? "ok" : "failed no samples written";
    }

    std::string place_eye(std::istream& words) {
        baseline::View view;
        words >> view;
        camera_->setPosition(place_of(view.eye));
        camera_->setTarget(place_of(view.target));
        camera_->updateAbsolutePosition();
        camera_->setNearValue(view.near);
        camera_->setFarValue(view.far);
        return words ? "ok" : "failed eight numbers were expected";
    }

    void draw_frame() {
        driver_->beginScene(true, true, background_);
        scene_->drawAll();
        glFinish();
    }

    std::string draw() {
        device_->run();
        const auto begin = std::chrono::steady_clock::now();
        draw_frame();
        const std::chrono::duration<double, std::milli> took =
            std::chrono::steady_clock::now() - begin;
        driver_->endScene();
        std::ostringstream text;
        text << "ok " << took.count() << ' ' << driver_->getPrimitiveCountDrawn(0);
        return text.str();
    }

    std::string write_depth(const std::string& name) {
        device_->run();
        draw_frame();
        const core::dimension2du size = driver_->getScreenSize();
        std::vector<f32> depths(std::size_t{size.Width} * size.Height);
        glReadPixels(0, 0, static_cast<GLsizei>(size.Width), static_cast<GLsizei>(size.Height),
                     GL_DEPTH_COMPONENT, GL_FLOAT, depths.data());
        driver_->endScene();
        // Irrlicht's projection ends at z 0, where OpenGL's begins at -1.
        for (f32& depth : depths) {
            depth = 2.0F * depth - 1.0F;
        }
        const core::dimension2du expected(arguments_.width, arguments_.height);
        return size == expected && baseline::write_floats(name, depths)
                   ? "ok"
                   : "failed no depths of that size written";
    }

    baseline::Arguments arguments_;
    IrrlichtDevice* device_ = nullptr;
    video::IVideoDriver* driver_ = nullptr;
    scene::ISceneManager* scene_ = nullptr;
    scene::ICameraSceneNode* camera_ = nullptr;
    scene::ITerrainSceneNode* terrain_ = nullptr;
    std::optional<baseline::ReliefPlane> relief_;
    video::SColor background_{255, 160, 190, 220};
    video::ITexture* texture_ = nullptr;
};

} // namespace

int main(int argc, char** argv) {
    return baseline::answer_lines<Renderer>({argv, argv + argc}, "Irrlicht");
}
