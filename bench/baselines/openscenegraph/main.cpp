// Draws a terrain with OpenSceneGraph for reljef-bench, see bench/baselines/program/protocol.h.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <osg/GL>
#include <osg/Geometry>
#include <osg/Image>
#include <osg/Notify>
#include <osg/Shape>
#include <osgTerrain/GeometryTechnique>
#include <osgTerrain/Layer>
#include <osgTerrain/Locator>
#include <osgTerrain/TerrainTile>
#include <osgViewer/Viewer>

#include "bench/baselines/program/program.h"

namespace {

namespace baseline = reljef::bench::baseline;

osg::Vec3d place_of(const baseline::Place& place) {
    return {place.east, place.north, place.up};
}

// After all has been drawn, before the buffers are swapped.
struct FrameEnd : osg::Camera::DrawCallback {
    bool reads_depths = false;
    int width = 0;
    int height = 0;
    mutable std::chrono::steady_clock::time_point time;
    mutable std::vector<float> depths;

    void operator()(osg::RenderInfo& /*info*/) const override {
        glFinish();
        time = std::chrono::steady_clock::now();
        if (reads_depths) {
            depths.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
            glReadPixels(0, 0, width, height, GL_DEPTH_COMPONENT, GL_FLOAT, depths.data());
        }
    }
};

class Renderer {
public:
    explicit Renderer(baseline::Arguments arguments) : arguments_(std::move(arguments)) {
        osg::setNotifyLevel(osg::FATAL);
        const osg::ref_ptr<osg::GraphicsContext::Traits> traits = new osg::GraphicsContext::Traits;
        traits->width = static_cast<int>(arguments_.width);
        traits->height = static_cast<int>(arguments_.height);
        traits->depth = 24;
        traits->vsync = false;
        traits->doubleBuffer = true;
        traits->windowDecoration = false;
        traits->readDISPLAY();
        traits->setUndefinedScreenDetailsToDefaultScreen();
        window_ = osg::GraphicsContext::createGraphicsContext(traits);
        if (!window_.valid()) {
            return;
        }
        end_ = new FrameEnd;
        end_->width = traits->width;
        end_->height = traits->height;
        osg::Camera& camera = *viewer_.getCamera();
        camera.setGraphicsContext(window_);
        camera.setViewport(0, 0, traits->width, traits->height);
        camera.setClearColor({0.63F, 0.75F, 0.86F, 1.0F});
        camera.setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
        camera.setFinalDrawCallback(end_);
        viewer_.setThreadingModel(osgViewer::Viewer::SingleThreaded);
        viewer_.setLightingMode(osg::View::NO_LIGHT);
        viewer_.setKeyEventSetsDone(0);
        viewer_.setSceneData(make_terrain());
        viewer_.realize();
    }

    [[nodiscard]] bool is_open() const { return window_.valid(); }

    std::string answer(const std::string& command, std::istream& words) {
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
        return "failed '" + command + "' found, view, draw, depth or quit was expected";
    }

private:
    osg::ref_ptr<osg::Node> make_terrain() {
        const auto side = static_cast<int>(arguments_.side);
        const double east = 0.5 * arguments_.east * (side - 1);
        const double north = 0.5 * arguments_.north * (side - 1);
        const osg::ref_ptr<osgTerrain::Locator> locator = new osgTerrain::Locator;
        locator->setCoordinateSystemType(osgTerrain::Locator::PROJECTED);
        locator->setTransformAsExtents(-east, -north, east, north);
        const osg::ref_ptr<osgTerrain::HeightFieldLayer> heights =
            new osgTerrain::HeightFieldLayer(make_heights());
        heights->setLocator(locator);
        const osg::ref_ptr<osgTerrain::ImageLayer> colors =
            new osgTerrain::ImageLayer(make_colors());
        colors->setLocator(locator);
        const osg::ref_ptr<osgTerrain::TerrainTile> tile = new osgTerrain::TerrainTile;
        tile->setLocator(locator);
        tile->setElevationLayer(heights);
        tile->setColorLayer(0, colors);
        tile->setTerrainTechnique(new osgTerrain::GeometryTechnique); // a vertex for every sample
        tile->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF |
                                                              osg::StateAttribute::OVERRIDE);
        return tile;
    }

    osg::ref_ptr<osg::HeightField> make_heights() {
        const unsigned side = arguments_.side;
        osg::ref_ptr<osg::HeightField> field = new osg::HeightField;
        field->allocate(side, side);
        for (unsigned col = 0; col < side; ++col) {
            for (unsigned row = 0; row < side; ++row) { // from the south
                field->setHeight(col, row, arguments_.heights[std::size_t{col} * side + row]);
            }
        }
        field->setXInterval(arguments_.east);
        field->setYInterval(arguments_.north);
        return field;
    }

    osg::ref_ptr<osg::Image> make_colors() {
        const unsigned side = arguments_.side;
        osg::ref_ptr<osg::Image> image = new osg::Image;
        image->allocateImage(static_cast<int>(side), static_cast<int>(side), 1, GL_RGB,
                             GL_UNSIGNED_BYTE);
        for (unsigned row = 0; row < side; ++row) {
            for (unsigned col = 0; col < side; ++col) {
                const std::uint8_t* const color =
                    &arguments_.colors[3 * (std::size_t{row} * side + col)];
                std::copy(color, color + 3, image->data(col, side - 1 - row));
            }
        }
        return image;
    }

    std::string place_eye(std::istream& words) {
        baseline::View view;
        words >> view;
        osg::Camera& camera = *viewer_.getCamera();
        camera.setViewMatrixAsLookAt(place_of(view.eye), place_of(view.target),
                                     osg::Vec3d(0.0, 0.0, 1.0));
        camera.setProjectionMatrixAsPerspective(
            arguments_.fov, static_cast<double>(arguments_.width) / arguments_.height, view.near,
            view.far);
        return words ? "ok" : "failed eight numbers were expected";
    }

    std::string draw() {
        end_->reads_depths = false;
        const auto begin = std::chrono::steady_clock::now();
        viewer_.frame();
        const std::chrono::duration<double, std::milli> took = end_->time - begin;
        const std::size_t cells = arguments_.side - 1;
        std::ostringstream text;
        text << "ok " << took.count() << ' ' << 2 * cells * cells;
        return text.str();
    }

    std::string write_depth(const std::string& name) {
        end_->reads_depths = true;
        viewer_.frame();
        return baseline::write_floats(name, end_->depths) ? "ok" : "failed no depths written";
    }

    baseline::Arguments arguments_;
    osg::ref_ptr<osg::GraphicsContext> window_;
    osg::ref_ptr<FrameEnd> end_;
    osgViewer::Viewer viewer_;
};

} // namespace

int main(int argc, char** argv) {
    return baseline::answer_lines<Renderer>({argv, argv + argc}, "OpenSceneGraph");
}
