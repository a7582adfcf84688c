#include "engine/io/raster/references.h"

#include <filesystem>

#include <cpl_conv.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "engine/io/raster/gdal_dataset.h"
#include "engine/io/raster/raster.h"
#include "engine/io/remote/read_scope.h"
#include "engine/io/terrain_file.h"
#include "tests/io/made_raster.h"
#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;
namespace fs = std::filesystem;

/// The text of a virtual raster of 8 by 8 samples; its source may have `attributes`.
std::string virtual_raster(const std::string& source, const std::string& attributes) {
    return fmt::format(R"(<VRTDataset rasterXSize="8" rasterYSize="8">)"
                       R"(<VRTRasterBand dataType="Float32" band="1"><SimpleSource>)"
                       R"(<SourceFilename {}>{}</SourceFilename></SimpleSource></VRTRasterBand>)"
                       "</VRTDataset>",
                       attributes, source);
}
constexpr const char* beside = R"(relativeToVRT="1")";

/// A folder with a raster in it, and one outside.
class References : public ::testing::Test {
protected:
    References() {
        fs::create_directories(inside_ / "sub");
        for (const fs::path& path : {outside_, inside_ / "a.tif", inside_ / "sub" / "a.tif"}) {
            EXPECT_TRUE(
                test::write(test::made_raster(8, 8, [](int col, int) { return col; }), path));
        }
    }
    ~References() override { allow_external(false); }
    References(const References&) = delete;
    References& operator=(const References&) = delete;

    [[nodiscard]] fs::path write(const std::string& name, const std::string& text) const {
        return folder_.write("inside/" + name, text);
    }
    /// The error of reading all samples; empty: none.
    [[nodiscard]] static std::string error_of(const fs::path& path) {
        const auto terrain = read_terrain(path);
        return terrain ? "" : terrain.error().message;
    }
    [[nodiscard]] std::string error_of_source(const std::string& source,
                                              const std::string& attributes = beside) const {
        return error_of(write("a.vrt", virtual_raster(source, attributes)));
    }

    test::TemporaryFolder folder_;
    fs::path outside_ = folder_.path() / "outside.tif";
    fs::path inside_ = folder_.path() / "inside";
};

TEST_F(References, AVirtualRasterReadsWhatIsInOrBelowItsFolder) {
    EXPECT_EQ(error_of_source("a.tif"), "");
    EXPECT_EQ(error_of_source("sub/a.tif"), "");
    EXPECT_EQ(error_of_source("sub/../a.tif"), "");
    EXPECT_EQ(error_of_source((inside_ / "sub" / "a.tif").string()), "");
    EXPECT_EQ(error_of_source((inside_ / "a.tif").string(), ""), "");
}

TEST_F(References, AVirtualRasterReadsNothingOutsideItsFolder) {
    fs::create_symlink(outside_, inside_ / "link.tif");
    fs::create_directory_symlink(folder_.path(), inside_ / "up");
    const std::string archive = "/vsizip/" + outside_.string();
    for (const std::string& source :
         {outside_.string(), std::string("../outside.tif"), std::string("sub/../../outside.tif"),
          std::string("link.tif"), std::string("up/outside.tif"), archive,
          std::string("/vsicurl/http://127.0.0.1:9/a.tif"), std::string("http://127.0.0.1:9/a.tif"),
          std::string("/vsistdin/"), "GTIFF_DIR:1:" + outside_.string(),
          "vrt://" + outside_.string(), std::string("&lt;VRTDataset/&gt;"),
          std::string("MEM:::DATAPOINTER=1,PIXELS=8,LINES=8")}) {
        for (const char* const attributes : {"", beside}) {
            EXPECT_THAT(error_of_source(source, attributes),
                        StartsWith((inside_ / "a.vrt").string() + ": refers to "))
                << source;
        }
    }
}

TEST_F(References, ANameThatMeansAnotherFileToGdalIsRefused) {
    // Beside the file of this very name, GDAL reads directory 1 of another.
    fs::create_directories(inside_ / ("GTIFF_DIR:1:" + folder_.path().string().substr(1)));
    fs::copy_file(outside_, inside_ / ("GTIFF_DIR:1:" + outside_.string().substr(1)));
    EXPECT_THAT(error_of_source("GTIFF_DIR:1:" + outside_.string().substr(1)),
                HasSubstr("refers to"));
}

TEST_F(References, AllNamesOfAVirtualRasterAreChecked) {
    const std::string inner = virtual_raster("../../outside.tif", beside);
    EXPECT_TRUE(fs::exists(write("sub/inner.vrt", inner)));
    EXPECT_THAT(error_of_source("sub/inner.vrt"), HasSubstr("refers to ../../outside.tif"));

    const std::string outside = outside_.string();
    for (const std::string& element :
         {"<Overview><SourceFilename>" + outside + "</SourceFilename></Overview>",
          "<GDALWarpOptions><SourceDataset>" + outside + "</SourceDataset></GDALWarpOptions>",
          "<RPCTransformer><DEMPath>" + outside + "</DEMPath></RPCTransformer>",
          R"(<Metadata domain="OVERVIEWS"><MDI key="OVERVIEW_FILE">)" + outside +
              "</MDI></Metadata>",
          R"(<Metadata domain="GEOLOCATION"><MDI key="X_DATASET">)" + outside + "</MDI></Metadata>",
          R"(<OpenOptions><OOI key="ROOT_PATH">)" + folder_.path().string() +
              "</OOI></OpenOptions>"}) {
        const fs::path path = write("b.vrt", R"(<VRTDataset rasterXSize="8" rasterYSize="8">)" +
                                                 element + "</VRTDataset>");
        EXPECT_THAT(error_of(path), HasSubstr("refers to " + folder_.path().string())) << element;
    }
}

TEST_F(References, RawBytesAndProgramsOfAVirtualRasterAreRefused) {
    const fs::path raw =
        write("raw.vrt", R"(<VRTDataset rasterXSize="8" rasterYSize="8">)"
                         R"(<VRTRasterBand dataType="Byte" band="1" subClass="VRTRawRasterBand">)"
                         R"(<SourceFilename relativeToVRT="1">a.tif</SourceFilename>)"
                         "<PixelOffset>2000000000</PixelOffset></VRTRasterBand></VRTDataset>");
    EXPECT_THAT(error_of(raw), HasSubstr("raw bytes"));
    const fs::path program =
        write("python.vrt",
              R"(<VRTDataset rasterXSize="8" rasterYSize="8">)"
              R"(<VRTRasterBand dataType="Float32" band="1" subClass="VRTDerivedRasterBand">)"
              "<PixelFunctionType>f</PixelFunctionType>"
              "<PixelFunctionLanguage>Python</PixelFunctionLanguage><PixelFunctionCode>"
              "def f(*a, **k): open('" +
                  (folder_.path() / "ran").string() +
                  "', 'w')</PixelFunctionCode><SimpleSource>"
                  R"(<SourceFilename relativeToVRT="1">a.tif</SourceFilename></SimpleSource>)"
                  "</VRTRasterBand></VRTDataset>");
    EXPECT_NE(error_of(program), "");
    EXPECT_FALSE(fs::exists(folder_.path() / "ran"));
}

TEST_F(References, SidecarFilesLeadNowhereElse) {
    for (const char* const file :
         {"a.tif.ovr", "a.tif.msk", "a.tif.aux.xml", "a.hdr", "a.prj", "a.PRJ", "a.tfw", "a.rrd",
          "a.rdc", "a.aux", "a.wld", "a.xml", "a.ovr"}) {
        const fs::path sidecar = inside_ / file;
        fs::create_symlink(outside_, sidecar);
        EXPECT_THAT(error_of(inside_ / "a.tif"), HasSubstr("refers to")) << file;
        fs::remove(sidecar);
    }
    const fs::path overview = write("a.tif.ovr", virtual_raster("../outside.tif", beside));
    const GdalMessages messages;
    const auto raster = open_raster(inside_ / "a.tif", messages);
    EXPECT_TRUE(!raster || (*raster)->GetRasterBand(1)->GetOverviewCount() == 0);
    fs::remove(overview);
    static_cast<void>(write(
        "a.tif.aux.xml", R"(<PAMDataset><Metadata domain="OVERVIEWS"><MDI key="OVERVIEW_FILE">)" +
                             outside_.string() + "</MDI></Metadata></PAMDataset>"));
    EXPECT_THAT(error_of(inside_ / "a.tif"), HasSubstr("refers to " + outside_.string()));
}

TEST_F(References, AMemberOfAnArchiveStaysInTheArchive) {
    const fs::path path = inside_ / "a.zip";
    ASSERT_TRUE(test::add_to_zip(path, "a.vrt", virtual_raster("in.tif", beside)));
    ASSERT_TRUE(test::add_to_zip(path, "b.vrt", virtual_raster(outside_.string(), beside)));
    ASSERT_TRUE(test::add_to_zip(path, "c.vrt", virtual_raster("../../outside.tif", beside)));
    ASSERT_TRUE(test::add_to_zip(path, "in.tif", test::read_bytes(outside_)));
    EXPECT_EQ(error_of(path), "");
    for (const char* const name : {"/b.vrt", "/c.vrt"}) {
        const std::string member = "/vsizip/{" + path.string() + "}" + name;
        EXPECT_THAT(error_of(member), StartsWith(member + ": refers to"));
    }
}

TEST_F(References, ALinkThatTheUserNamesIsTheFileItself) {
    const fs::path path = write("a.vrt", virtual_raster("a.tif", beside));
    const fs::path link = folder_.path() / "link.vrt";
    fs::create_symlink(path, link);
    EXPECT_EQ(error_of(link), "");
    fs::create_symlink(inside_ / "a.tif", folder_.path() / "link.tif");
    EXPECT_EQ(error_of(folder_.path() / "link.tif"), "");
}

TEST_F(References, AllowExternalLiftsThis) {
    allow_external(true);
    EXPECT_EQ(error_of_source("../outside.tif"), "");
    allow_external(false);
    EXPECT_THAT(error_of_source("../outside.tif"), HasSubstr("--allow-external"));
}

TEST_F(References, OtherVirtualFileSystemsAreRefused) {
    for (const std::string name : {"/vsizip/a.zip", "/vsigzip/a.gz", "/vsitar/a.tar/b.tif",
                                   "/vsicurl/http://host/a", "a.tif", "a/vsi.tif"}) {
        EXPECT_TRUE(check_typed_name(name)) << name;
    }
    for (const std::string name : {"/vsistdin/", "/vsisubfile/8,a.tif", "/vsizip//vsistdin/",
                                   "/vsimem/a.tif", "/vsicrypt/a", "<VRTDataset>/a.tif"}) {
        EXPECT_FALSE(check_typed_name(name)) << name;
        EXPECT_THAT(error_of(name), StartsWith(name + ": ")) << name;
    }
}

TEST_F(References, ReadersWithoutDeadlinesAndRulesForRedirectsAreRefused) {
    for (const std::string name : {"/vsis3/b/a.tif", "/vsigs/b/a.tif", "/vsiaz/b/a.tif"}) {
        EXPECT_THAT(error_of(name), HasSubstr("--allow-external lifts this"));
        allow_external(true);
        EXPECT_TRUE(check_typed_name(name)) << name;
        allow_external(false);
    }
    for (const std::string name :
         {"/vsicurl?url=http://127.0.0.1:9/a.tif", "/vsizip/{/vsicurl?url=http://127.0.0.1:9/a}/b",
          "/vsicurl_streaming/http://127.0.0.1:9/a.tif"}) {
        EXPECT_THAT(error_of(name), HasSubstr(": uses /vsicurl")) << name;
    }
}

TEST_F(References, CoordinateSystemsOfAVirtualRasterNameNoFileAndNoServer) {
    const auto with = [&](const std::string& element) {
        return error_of(write("a.vrt", R"(<VRTDataset rasterXSize="8" rasterYSize="8">)" + element +
                                           "</VRTDataset>"));
    };
    for (const std::string& crs :
         {std::string("http://127.0.0.1:9/crs"), std::string("HTTPS://127.0.0.1:9/crs"),
          std::string(" ftp://127.0.0.1:9/crs"), std::string("/vsicurl/http://127.0.0.1:9/crs"),
          outside_.string(), std::string("../outside.prj"), std::string("outside.prj"),
          std::string("ESRI::/etc/hostname"), std::string("+proj=longlat +nadgrids=/etc/hostname"),
          std::string("+init=/etc/hostname:1")}) {
        for (const std::string& element :
             {"<SRS>" + crs + "</SRS>", R"(<GCPList Projection=")" + crs + R"("/>)",
              "<RPCTransformer><DEMSRS>" + crs + "</DEMSRS></RPCTransformer>",
              "<GDALWarpOptions><Transformer><ReprojectionTransformer><SourceSRS>" + crs +
                  "</SourceSRS></ReprojectionTransformer></Transformer></GDALWarpOptions>",
              R"(<Metadata domain="GEOLOCATION"><MDI key="SRS">)" + crs + "</MDI></Metadata>",
              R"(<Option key="COORDINATE_OPERATION">)" + crs + "</Option>"}) {
            EXPECT_THAT(with(element), HasSubstr("has the coordinate system")) << element;
        }
    }
    for (const std::string crs :
         {"", "EPSG:32631", "epsg:4326+5773", "WGS84", "urn:ogc:def:crs:EPSG::4326",
          "+proj=utm +zone=31", "LOCAL_CS[&quot;a/b&quot;]", "\n PROJCRS [&quot;a&quot;]"}) {
        EXPECT_THAT(with("<SRS>" + crs + "</SRS>"), testing::Not(HasSubstr("coordinate system")))
            << crs;
    }
}

TEST_F(References, CoordinateSystemsOfSidecarFilesNameNoFile) {
    auto raster = test::made_raster(8, 8, [](int col, int) { return col; });
    raster.format = "RST";
    const fs::path path = inside_ / "i.rst";
    if (test::write(raster, path)) {
        EXPECT_EQ(error_of(path), "");
        std::string text = test::read_bytes(inside_ / "i.rdc");
        const auto at = text.find("ref. system");
        ASSERT_NE(at, std::string::npos);
        text.replace(at, text.find('\n', at) - at, "ref. system : ../outside");
        static_cast<void>(write("i.rdc", text));
        EXPECT_THAT(error_of(path), HasSubstr("has the coordinate system"));
    }
    static_cast<void>(write("a.tif.aux.xml",
                            R"(<PAMDataset><Metadata domain="GEOLOCATION"><MDI key="SRS">)"
                            "/etc/hostname</MDI></Metadata></PAMDataset>"));
    EXPECT_THAT(error_of(inside_ / "a.tif"), HasSubstr("has the coordinate system"));
}

TEST_F(References, ABandComputedFromManySourcesAsksForNoMemory) {
    const fs::path path =
        write("sum.vrt", R"(<VRTDataset rasterXSize="8" rasterYSize="8"><VRTRasterBand )"
                         R"(dataType="Float64" band="1" subClass="VRTDerivedRasterBand">)"
                         "<PixelFunctionType>sum</PixelFunctionType><SimpleSource>"
                         R"(<SourceFilename relativeToVRT="1">a.tif</SourceFilename>)"
                         "</SimpleSource></VRTRasterBand></VRTDataset>");
    EXPECT_THAT(error_of(path), HasSubstr("computed from others"));
}

TEST_F(References, TheTextOfAVirtualRasterAsksForLittleMemory) {
    const fs::path path = write("long.vrt", "<VRTDataset");
    fs::resize_file(path, 17'000'000); // sparse
    EXPECT_THAT(error_of(path), HasSubstr("bytes, at most 16777216 were expected"));
}

TEST_F(References, TheEnvironmentLiftsNothing) {
    const CPLConfigOptionSetter option("RELJEF_ALLOW_EXTERNAL", "YES", false);
    EXPECT_THAT(error_of_source("../outside.tif"), HasSubstr("--allow-external"));
}

TEST_F(References, AFileThatNamesServersIsNoRaster) {
    const std::string text = "<GDAL_WMS><Service name=\"TMS\"><ServerUrl>http://127.0.0.1:9/${z}"
                             "</ServerUrl></Service><DataWindow><SizeX>8</SizeX><SizeY>8</SizeY>"
                             "</DataWindow></GDAL_WMS>";
    EXPECT_THAT(error_of(write("a.xml", text)), HasSubstr("cannot be opened"));
    EXPECT_NE(error_of_source("a.xml"), "");
}

TEST_F(References, AVirtualRasterNamesNoFileInAnAttribute) {
    const auto path =
        write("a.vrt", fmt::format(R"(<VRTDataset rasterXSize="8" rasterYSize="8">)"
                                   R"(<VRTRasterBand dataType="Float32" band="1">)"
                                   R"(<SimpleSource SourceFilename="{}"/></VRTRasterBand>)"
                                   "</VRTDataset>",
                                   outside_.string()));
    EXPECT_THAT(error_of(path), HasSubstr("refers to " + outside_.string()));
}

TEST_F(References, ASourceThatIsReadWholeIsRefused) {
    for (const char* source : {"AveragedSource", "KernelFilteredSource"}) {
        const auto path =
            write("a.vrt", fmt::format(R"(<VRTDataset rasterXSize="8" rasterYSize="8">)"
                                       R"(<VRTRasterBand dataType="Float32" band="1"><{0}>)"
                                       R"(<SourceFilename relativeToVRT="1">a.tif</SourceFilename>)"
                                       "</{0}></VRTRasterBand></VRTDataset>",
                                       source));
        EXPECT_THAT(error_of(path), HasSubstr(std::string("has an ") + source));
    }
}

TEST_F(References, ACoordinateSystemOpensNoGridByItsPath) {
    const auto path = write(
        "a.vrt", R"(<VRTDataset rasterXSize="8" rasterYSize="8"><SRS>+proj=utm +zone=33 )"
                 R"(+ellps=bessel +nadgrids=/etc/passwd +units=m</SRS><GeoTransform>)"
                 R"(5e5,10,0,5e6,0,-10</GeoTransform><VRTRasterBand dataType="Float32" band="1">)"
                 R"(<SimpleSource><SourceFilename relativeToVRT="1">a.tif</SourceFilename>)"
                 "</SimpleSource></VRTRasterBand></VRTDataset>");
    EXPECT_THAT(error_of(path), HasSubstr("has the coordinate system"));
}

// PROJ ended the program.
TEST_F(References, AGeographicSystemWithTheCodeOfAGeocentricOneIsRefused) {
    for (const char* const code : {"4978", "5341"}) {
        const auto path =
            write("a.vrt",
                  fmt::format(R"(<VRTDataset rasterXSize="8" rasterYSize="8"><SRS>GEOGCS["WGS 84",)"
                              R"(DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],)"
                              R"(PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433],)"
                              R"(AUTHORITY["EPSG","{}"]]</SRS><GeoTransform>6,0.1,0,45,0,-0.1)"
                              R"(</GeoTransform><VRTRasterBand dataType="Float32" band="1">)"
                              R"(<SimpleSource><SourceFilename relativeToVRT="1">a.tif)"
                              "</SourceFilename></SimpleSource></VRTRasterBand></VRTDataset>",
                              code));
        EXPECT_THAT(error_of(path),
                    HasSubstr(fmt::format("has the code EPSG:{} of a geocentric", code)));
    }
}

TEST_F(References, APipeBesideOrBehindARasterBlocksNothing) {
    const fs::path pipe = inside_ / "a.tif.ovr";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_THAT(error_of(inside_ / "a.tif"), HasSubstr("a.tif.ovr: is no regular file"));
    fs::rename(pipe, inside_ / "pipe.tif");
    EXPECT_THAT(error_of_source("pipe.tif"), HasSubstr("refers to pipe.tif"));
}

TEST_F(References, AStopEndsOpeningWhatAFileRefersTo) {
    std::stop_source stop;
    stop.request_stop();
    const ReadScope scope(stop.get_token());
    EXPECT_THAT(error_of(inside_ / "a.tif"), HasSubstr("reading was stopped"));
}

} // namespace
} // namespace reljef::io
