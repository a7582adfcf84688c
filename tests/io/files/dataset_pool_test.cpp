#include "engine/io/files/dataset_pool.h"

#include <chrono>

#include <gtest/gtest.h>

#include "tests/io/made_raster.h"
#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

class Datasets : public ::testing::Test {
protected:
    Datasets() { put(1.0, std::chrono::seconds(0)); }

    /// A raster of one height takes the place of what is there, as another file of the same size.
    void put(double height, std::chrono::seconds later) {
        const auto raster = test::made_raster(4, 4, [&](int, int) { return height; });
        const auto beside = folder_.path() / "beside.tif";
        ASSERT_TRUE(test::write(raster, beside));
        std::filesystem::last_write_time(beside, start_ + later);
        std::filesystem::rename(beside, file_);
    }
    DatasetPool::Loan borrowed() {
        const GdalMessages messages;
        auto loan = pool_.borrow(file_, messages);
        EXPECT_TRUE(loan) << (loan ? "" : loan.error().message);
        return std::move(*loan);
    }
    static double height_in(const DatasetPool::Loan& loan) {
        double height = 0.0;
        EXPECT_EQ(loan->GetRasterBand(1)->RasterIO(GF_Read, 1, 1, 1, 1, &height, 1, 1, GDT_Float64,
                                                   0, 0, nullptr),
                  CE_None);
        return height;
    }

    const std::filesystem::file_time_type start_ = std::filesystem::file_time_type::clock::now();
    const test::TemporaryFolder folder_;
    const std::filesystem::path file_ = folder_.path() / "a.tif";
    int opened_ = 0;
    DatasetPool pool_{[&](const std::filesystem::path& path, const GdalMessages& messages) {
        ++opened_;
        return open_raster(path, messages);
    }};
};

TEST_F(Datasets, StayOpenBetweenReadings) {
    EXPECT_EQ(height_in(borrowed()), 1.0);
    EXPECT_EQ(height_in(borrowed()), 1.0);
    EXPECT_EQ(opened_, 1);
}

TEST_F(Datasets, AreOpenedAnewWhereTheFileWasReplacedBetweenReadings) {
    EXPECT_EQ(height_in(borrowed()), 1.0);
    put(2.0, std::chrono::seconds(1));
    EXPECT_EQ(height_in(borrowed()), 2.0);
    EXPECT_EQ(opened_, 2);
}

TEST_F(Datasets, AreOpenedAnewWhereTheFileWasReplacedDuringAReading) {
    {
        const auto loan = borrowed();
        put(2.0, std::chrono::seconds(1));
        EXPECT_EQ(height_in(loan), 1.0);
    }
    EXPECT_EQ(height_in(borrowed()), 2.0);
    EXPECT_EQ(height_in(borrowed()), 2.0);
    EXPECT_EQ(opened_, 2);
}

TEST_F(Datasets, OfChangedFilesAreCountedAndToldOnce) {
    EXPECT_FALSE(borrowed().found_change());
    EXPECT_FALSE(borrowed().found_change());
    for (const int change : {1, 2}) {
        put(change, std::chrono::seconds(change));
        EXPECT_EQ(pool_.changes(), static_cast<std::uint64_t>(change - 1));
        EXPECT_TRUE(borrowed().found_change());
        EXPECT_FALSE(borrowed().found_change());
        EXPECT_EQ(pool_.changes(), static_cast<std::uint64_t>(change));
    }
}

TEST_F(Datasets, OfAFileThatWasAwayAreUnchanged) {
    EXPECT_FALSE(borrowed().found_change());
    const auto away = folder_.path() / "away.tif";
    std::filesystem::rename(file_, away);
    const GdalMessages messages;
    EXPECT_FALSE(pool_.borrow(file_, messages));
    std::filesystem::rename(away, file_);
    EXPECT_FALSE(borrowed().found_change());
    EXPECT_EQ(pool_.changes(), 0U);
}

} // namespace
} // namespace reljef::io
