// Draws a terrain with Irrlicht's terrain node for reljef-bench, see protocol.h.
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <GL/gl.h>
#include <irrlicht/irrlicht.h>

namespace {

using namespace irr;

struct Arguments {
    core::dimension2du size;
    f32 fov = 1.0F; // radians
    u32 side = 0;
    core::vector3df spacing; // metres east, up, north
    std::vector<f32> heights;
    std::vector<u8> colors;
};

template <class T> std::vector<T> read_all(const std::string& name, std::size_t count) {
    std::vector<T> values(count);
    std::ifstream file(name, std::ios::binary);
    file.read(reinterpret_cast<char*>(values.data()),
              static_cast<std::streamsize>(count * sizeof(T)));
    return file ? values : std::vector<T>();
}

std::optional<Arguments> arguments_of(const std::vector<std::string>& words) {
    if (words.size() != 9) {
        return std::nullopt;
    }
    Arguments arguments;
    arguments.size = {static_cast<u32>(std::stoul(words[1])),
                      static_cast<u32>(std::stoul(words[2]))};
    arguments.fov = std::stof(words[3]) * core::DEGTORAD;
    arguments.side = static_cast<u32>(std::stoul(words[4]));
    arguments.spacing = {std::stof(words[5]), 1.0F, std::stof(words[6])};
    const std::size_t samples = std::size_t{arguments.side} * arguments.side;
    arguments.heights = read_all<f32>(words[7], samples);
    arguments.colors = read_all<u8>(words[8], 3 * samples);
    if (arguments.heights.empty() || arguments.colors.empty()) {
        return std::nullopt;
    }
    return arguments;
}

// Irrlicht's axes are east, up, north.
core::vector3df from_east_north_up(std::istream& words) {
    f32 east = 0.0F;
    f32 north = 0.0F;
    f32 up = 0.0F;
    words >> east >> north >> up;
    return {east, up, north};
}

class Renderer {
public:
    explicit Renderer(Arguments arguments) : arguments_(std::move(arguments)) {
        SIrrlichtCreationParameters parameters;
        parameters.DriverType = video::EDT_OPENGL;
        parameters.WindowSize = arguments_.size;
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
        camera_->setFOV(arguments_.fov);
        camera_->setAspectRatio(static_cast<f32>(arguments_.size.Width) /
                                static_cast<f32>(arguments_.size.Height));
        texture_ = make_texture();
    }
    Renderer(const Renderer&) = delete;
    ~Renderer() {
        if (device_ != nullptr) {
            device_->drop();
        }
    }

    [[nodiscard]] bool is_open() const { return device_ != nullptr; }

    std::string answer(const std::string& line) {
        std::istringstream words(line);
        std::string command;
        words >> command;
        if (command == "lods") {
            s32 levels = 1;
            words >> levels;
            return build(levels) ? "ok" : "failed Irrlicht builds no terrain of these heights";
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
        return "failed '" + command + "' found, lods, view, draw, depth or quit was expected";
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
        const core::vector3df corner = arguments_.spacing * core::vector3df(-half, 0.0F, -half);
        terrain_ = scene_->addTerrainSceneNode(static_cast<io::IReadFile*>(nullptr), nullptr, -1,
                                               corner, {}, arguments_.spacing, {255, 255, 255, 255},
                                               levels, scene::ETPS_17, 0, true);
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

    std::string place_eye(std::istream& words) {
        const core::vector3df eye = from_east_north_up(words);
        const core::vector3df target = from_east_north_up(words);
        f32 near = 1.0F;
        f32 far = 2.0F;
        words >> near >> far;
        camera_->setPosition(eye);
        camera_->setTarget(target);
        camera_->updateAbsolutePosition();
        camera_->setNearValue(near);
        camera_->setFarValue(far);
        return words ? "ok" : "failed eight numbers were expected";
    }

    void draw_frame() {
        driver_->beginScene(true, true, {255, 160, 190, 220});
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
        std::ofstream file(name, std::ios::binary);
        file.write(reinterpret_cast<const char*>(depths.data()),
                   static_cast<std::streamsize>(depths.size() * sizeof(f32)));
        return file && size == arguments_.size ? "ok" : "failed no depths of that size written";
    }

    Arguments arguments_;
    IrrlichtDevice* device_ = nullptr;
    video::IVideoDriver* driver_ = nullptr;
    scene::ISceneManager* scene_ = nullptr;
    scene::ICameraSceneNode* camera_ = nullptr;
    scene::ITerrainSceneNode* terrain_ = nullptr;
    video::ITexture* texture_ = nullptr;
};

} // namespace

int main(int argc, char** argv) {
    auto arguments = arguments_of({argv, argv + argc});
    if (!arguments) {
        std::cout << "failed eight arguments and the files they name were expected" << std::endl;
        return EXIT_FAILURE;
    }
    Renderer renderer(std::move(*arguments));
    if (!renderer.is_open()) {
        std::cout << "failed Irrlicht opens no window here" << std::endl;
        return EXIT_FAILURE;
    }
    std::cout << "ok" << std::endl;
    for (std::string line; std::getline(std::cin, line) && line != "quit";) {
        std::cout << renderer.answer(line) << std::endl;
    }
    return EXIT_SUCCESS;
}
