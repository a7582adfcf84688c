// Files on servers that are slow, send readers elsewhere, or name files of this machine.
#include "engine/io/remote/remote_files.h"

#include <chrono>
#include <optional>
#include <thread>

#include <cpl_conv.h>
#include <cpl_vsi.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/io/raster/gdal_dataset.h"
#include "engine/io/remote/http_client.h"
#include "engine/io/remote/read_scope.h"
#include "engine/io/terrain_file.h"
#include "tests/io/made_raster.h"
#include "tests/support/nginx.h"
#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

using ::testing::HasSubstr;
using Clock = std::chrono::steady_clock;

// Busy machines take their time; without the limit that is tested, each read takes over 60 s.
constexpr std::chrono::seconds soon{10};

class RemoteFile : public ::testing::Test {
protected:
    void SetUp() override {
        RELJEF_NEED_NGINX();
        write("dem.tif", 0);
        server_.emplace(folder_.path());
    }
    void write(const std::string& name, int offset) const {
        auto raster = test::made_raster(
            side, side, [&](int col, int row) { return offset + (col * 7 + row * 13) % 1000; });
        raster.crs = "EPSG:32631";
        raster.geotransform = {300000.0, 10.0, 0.0, 5600000.0, 0.0, -10.0};
        raster.options = {"TILED=YES", "BLOCKXSIZE=128", "BLOCKYSIZE=128"};
        ASSERT_TRUE(test::write(raster, folder_.path() / name));
    }
    [[nodiscard]] std::string error_of(const std::string& name) const {
        const GdalMessages messages;
        const auto opened = open_raster(server_->url(name), messages);
        return opened ? "opened" : opened.error().message;
    }
    void expect_refusal(const std::string& name, const std::string& reason) const {
        EXPECT_THAT(error_of(name), testing::AllOf(HasSubstr(server_->url(name)), HasSubstr(reason),
                                                   testing::Not(HasSubstr("\n"))));
    }

    static constexpr int side = 512;
    test::TemporaryFolder folder_;
    std::optional<test::Nginx> server_;
};

TEST_F(RemoteFile, OfAServerAtAHundredAndFiftyBytesASecondIsGivenUpAtTheDeadline) {
    server_->serve_by("limit_rate 150;"); // dem.tif would take two hours
    HttpClient client({.start = 1.0, .min_bytes_per_second = 2000.0});
    const auto begin = Clock::now();
    const auto read = client.read(server_->url("dem.tif"), std::array{ByteRange{0, 1 << 20}});
    ASSERT_FALSE(read);
    EXPECT_THAT(read.error().message, HasSubstr("at least 2000 a second after the first 1 s"));
    EXPECT_LT(Clock::now() - begin, soon);
}

TEST_F(RemoteFile, ThatIsSlowIsNamedAndNotAskedForAgainAtOnce) {
    server_->serve_by("limit_rate 150;");
    const CPLConfigOptionSetter limit("GDAL_HTTP_TIMEOUT", "1", false);
    const auto begin = Clock::now();
    expect_refusal("dem.tif", "all were expected within 1 s");
    const auto first = Clock::now();
    expect_refusal("dem.tif", "all were expected within 1 s");
    EXPECT_LT(Clock::now() - first, first - begin);
    EXPECT_LT(Clock::now() - begin, soon);
}

TEST_F(RemoteFile, ThatIsSlowEndsAtAStop) {
    server_->serve_by("limit_rate_after 16k; limit_rate 2500;"); // fast enough, two minutes long
    std::stop_source stop;
    Clock::time_point stopped;
    const std::jthread user([&] {
        while (server_->bytes_sent() < 16384) { // the beginning is there
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        stopped = Clock::now();
        stop.request_stop();
    });
    RasterOptions options;
    options.stop = stop.get_token();
    const auto terrain = read_terrain(server_->url("dem.tif"), options);
    ASSERT_FALSE(terrain);
    EXPECT_EQ(terrain.error().message, server_->url("dem.tif") + ": reading was stopped");
    EXPECT_LT(Clock::now() - stopped, soon);
}

TEST_F(RemoteFile, IsNotReadBeyondARedirectToThisMachineOrWithoutHttps) {
    const std::string port = server_->url("").substr(std::string("http://127.0.0.1:").size());
    for (const std::string& to :
         {"http://127.0.0.1:" + port + "dem.tif", std::string("http://example.com/dem.tif"),
          std::string("file:///etc/hostname"), std::string("ftp://example.com/dem.tif"),
          "https://127.0.0.1:" + port + "dem.tif", "https://localhost:" + port + "dem.tif",
          "https://[::1]:" + port + "dem.tif", "https://[::ffff:127.0.0.1]:" + port + "dem.tif",
          std::string("https://169.254.169.254/dem.tif"), std::string("https://2130706433/a.tif"),
          std::string("//127.0.0.1/dem.tif"), std::string("/dem.tif")}) {
        server_->serve_by("location /moved { return 302 " + to + "; }");
        forget_remote_file(server_->url("moved.tif"));
        expect_refusal("moved.tif", "https:// addresses of public hosts were expected");
    }
}

TEST_F(RemoteFile, ThatIsVirtualNamesNoLocalFileAndNoOtherHost) {
    for (const std::string& source :
         {(folder_.path() / "dem.tif").string(), std::string("/etc/hostname"),
          std::string("/vsicurl/http://127.0.0.2/dem.tif"), std::string("dem.tif")}) {
        folder_.write("a.vrt", test::stretched_vrt(source, {.step = 1.0, .type = "Float32"}));
        forget_remote_file(server_->url("a.vrt"));
        expect_refusal("a.vrt", "is in the format Virtual Raster, which may name other files");
    }
    folder_.write("wms.xml", "<GDAL_WMS><Service name=\"TMS\"><ServerUrl>file:///etc/${x}"
                             "</ServerUrl></Service></GDAL_WMS>");
    expect_refusal("wms.xml", "cannot be opened as a raster");
}

TEST_F(RemoteFile, ThatNamesItsOverviewsAndPlacesLeadsToNoOtherFile) {
    auto raster = test::made_raster(side, side, [](int col, int) { return col; });
    for (const auto& [domain, key] :
         {std::pair{"OVERVIEWS", "OVERVIEW_FILE"}, std::pair{"GEOLOCATION", "X_DATASET"},
          std::pair{"GEOLOCATION", "Y_DATASET"}}) {
        for (const std::string& file :
             {(folder_.path() / "dem.tif").string(), "/vsicurl/" + server_->url("dem.tif")}) {
            raster.metadata = {{domain, key, file}};
            ASSERT_TRUE(test::write(raster, folder_.path() / "a.tif"));
            forget_remote_file(server_->url("a.tif"));
            expect_refusal("a.tif", "refers to " + file);
        }
    }
}

TEST_F(RemoteFile, ThatIsSlowForManyRequestsIsGivenUpAtOneDeadline) {
    HttpClient client;
    const auto read = [&] {
        return client.read(server_->url("dem.tif"), std::array{ByteRange{0, 16384}});
    };
    {
        const CPLConfigOptionSetter limit("GDAL_HTTP_TIMEOUT", "0.2", false);
        const ReadDeadline open;
        std::this_thread::sleep_for(std::chrono::milliseconds(1100)); // as by many requests
        const ReadDeadline inner;
        const auto late = read();
        ASSERT_FALSE(late);
        EXPECT_THAT(late.error().message, HasSubstr("in all, at most 1 s were expected"));
    }
    EXPECT_TRUE(read());
}

TEST_F(RemoteFile, ThatChangesWhileItIsOpenIsAnError) {
    const GdalMessages messages;
    auto opened = open_raster(server_->url("dem.tif"), messages);
    ASSERT_TRUE(opened) << opened.error().message;
    write("dem.tif", 5); // of the same length
    std::filesystem::last_write_time(folder_.path() / "dem.tif",
                                     std::filesystem::file_time_type::clock::now() +
                                         std::chrono::hours(1));
    std::vector<float> row(side);
    const auto read = [&](GDALDataset& dataset) {
        return dataset.GetRasterBand(1)->RasterIO(GF_Read, 0, side - 1, side, 1, row.data(), side,
                                                  1, GDT_Float32, 0, 0, nullptr);
    };
    EXPECT_EQ(read(**opened), CE_Failure);
    EXPECT_THAT(messages.reason(), HasSubstr("the file changed while it was read"));
    forget_remote_file(server_->url("dem.tif"));
    opened = open_raster(server_->url("dem.tif"), messages);
    ASSERT_TRUE(opened) << opened.error().message;
    EXPECT_EQ(read(**opened), CE_None);
    EXPECT_EQ(row[0], 5 + (side - 1) * 13 % 1000);
}

TEST_F(RemoteFile, OfAServerThatHasAllFilesIsAskedForNoSidecarFiles) {
    server_->serve_by("rewrite ^ /dem.tif break;");
    ASSERT_EQ(error_of("any.tif"), "opened");
    EXPECT_LT(server_->bytes_sent(), 3U * 16384U); // the head alone
    const std::string name = "/vsicurl/" + server_->url("any.tif");
    VSIStatBufL status{};
    EXPECT_EQ(VSIStatL((name + ".ovr").c_str(), &status), 0);
    EXPECT_EQ(VSIStatL((name + ".ovr.ovr").c_str(), &status), -1);
    EXPECT_EQ(VSIStatL((name + ".MSK.OVR").c_str(), &status), -1);
}

TEST_F(RemoteFile, ThatIsAnEndlessTextIsNotScanned) {
    std::string text;
    for (int i = 0; i < 1000; ++i) {
        text += fmt::format("{} {} 1\n", i % 10, i / 10);
    }
    std::filesystem::resize_file(folder_.write("a.xyz", text), 2'000'000'000); // takes no space
    expect_refusal("a.xyz", "is a text of 2.0 GB, at most 1.0 GB were expected of a server");
    folder_.write("b.xyz", text);
    EXPECT_EQ(error_of("b.xyz"), "opened");
}

TEST_F(RemoteFile, WithALongHeaderOrAddressIsRefusedInOneSentence) {
    const std::string value = "set $a \"" + std::string(1000, 'a') +
                              "\"; set $b $a$a$a$a$a$a$a$a$a$a; set $c $b$b$b$b$b$b$b$b$b$b$b$b;";
    server_->serve_by(value + " location = /dem.tif { add_header X $c; }");
    expect_refusal("dem.tif", "has a header of over 100 kB");
    server_->serve_by(value + " location /moved { return 302 https://127.0.0.1:1/$b; }");
    EXPECT_LT(error_of("moved.tif").size(), 600U);
    server_->serve_by("set $none \"\"; location /empty { return 302 $none; }");
    expect_refusal("empty.tif", "is redirected without an address");
}

TEST_F(RemoteFile, OfAServerThatSendsAllInsteadOfAPartIsRefused) {
    server_->serve_by("max_ranges 0;");
    expect_refusal("dem.tif", "a server of parts (byte ranges) was expected");
}

TEST_F(RemoteFile, OfAnotherProtocolIsRefused) {
    const GdalMessages messages;
    const auto opened = open_raster("ftp://127.0.0.1/dem.tif", messages);
    ASSERT_FALSE(opened);
    EXPECT_THAT(opened.error().message, HasSubstr("http:// or https:// address was expected"));
}

TEST_F(RemoteFile, ThatIsMissingIsAskedForOnce) {
    const auto sent_beyond = [&](std::size_t before) { // a moment after an answer came
        while (server_->bytes_sent() <= before) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return server_->bytes_sent();
    };
    EXPECT_THAT(error_of("none.tif"), HasSubstr("the server has no such file"));
    const std::size_t once = sent_beyond(0);
    EXPECT_THAT(error_of("none.tif"), HasSubstr("the server has no such file"));
    EXPECT_THAT(error_of("neither.tif"), HasSubstr("the server has no such file"));
    EXPECT_EQ(sent_beyond(once), 2 * once);
}

} // namespace
} // namespace reljef::io
