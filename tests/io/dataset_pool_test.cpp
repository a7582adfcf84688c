#include "engine/io/dataset_pool.h"

#include <gtest/gtest.h>

#include "tests/io/made_raster.h"
#include "tests/support/temporary_folder.h"

namespace reljef::io {
namespace {

class DatasetPools : public ::testing::Test {
protected:
    void write(int side) {
        std::filesystem::remove(file_);
        ASSERT_TRUE(test::write(test::made_raster(side, side, [](int, int) { return 1; }), file_));
        std::filesystem::last_write_time(file_, std::filesystem::last_write_time(file_) +
                                                    std::chrono::seconds(++written_));
    }
    [[nodiscard]] DatasetPool::Loan borrow() {
        auto loan = pool_.borrow(file_, messages_);
        EXPECT_TRUE(loan) << (loan ? "" : loan.error().message);
        return std::move(*loan);
    }

    test::TemporaryFolder folder_;
    std::filesystem::path file_ = folder_.path() / "a.tif";
    int written_ = 0;
    GdalMessages messages_;
    DatasetPool pool_;
};

TEST_F(DatasetPools, KeepAFileOpen) {
    write(3);
    const GDALDataset* first = &*borrow();
    EXPECT_EQ(&*borrow(), first);
}

TEST_F(DatasetPools, OpenAnewWhatWasReplacedWhileItWasLent) {
    write(3);
    {
        const auto lent = borrow();
        write(4);
        EXPECT_EQ(lent->GetRasterXSize(), 3);
    }
    EXPECT_EQ(borrow()->GetRasterXSize(), 4);
}

} // namespace
} // namespace reljef::io
