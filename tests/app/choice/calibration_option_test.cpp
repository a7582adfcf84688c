#include "app/choice/calibration_option.h"

#include <gtest/gtest.h>

#include "engine/core/atomic_file.h"
#include "engine/session/calibration/calibration.h"
#include "tests/support/temporary_folder.h"

namespace reljef::app {
namespace {

// The two examples of the help, one after the other, work on any machine.
TEST(CalibrationOption, IsUsedInItsContextIfNoneIsNamed) {
    const test::TemporaryFolder folder;
    cli::ViewChoice view;
    EXPECT_EQ(context_to_use(view).value(), std::nullopt);
    view.calibration = folder.path() / "costs.json";
    EXPECT_FALSE(context_to_use(view));
    const session::Calibration made{{"a processor", "reljef 1", "osmesa", "llvmpipe"}, {}};
    ASSERT_TRUE(write_text_file(view.calibration, session::to_text(made)));
    EXPECT_EQ(context_to_use(view).value(), session::BackendKind::osmesa);
    view.context = session::BackendKind::egl;
    EXPECT_EQ(context_to_use(view).value(), session::BackendKind::egl);
}

} // namespace
} // namespace reljef::app
