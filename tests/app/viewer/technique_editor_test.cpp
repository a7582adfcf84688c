#include "app/viewer/appearance/technique_editor.h"

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/command_line.h"
#include "tests/app/made_hill.h"
#include "tests/support/temporary_folder.h"

namespace reljef::app {
namespace {

using testing::HasSubstr;

scene::Technique relief_with(int linear_steps) {
    return {scene::Relief{.linear_steps = linear_steps}};
}

struct TechniqueEditorTest : testing::Test {
    session::TerrainScene scene = hill_scene();
    AppearanceSwitch changes{scene};
    TechniqueEditor editor{scene, changes, scene.materials().front()->technique};

    scene::Technique shown() { return scene.materials().front()->technique; }
    const TechniqueChoice& choice_of(const TechniqueContent& content, scene::TechniqueId id) {
        return *std::find_if(content.choices.begin(), content.choices.end(),
                             [&](const auto& choice) { return choice.technique.id() == id; });
    }
};

TEST_F(TechniqueEditorTest, OffersAllTechniquesAndSaysWhyOneDoesNotFit) {
    const TechniqueContent content = editor.content();
    EXPECT_EQ(content.choices.size(), scene::technique_catalogue().size());
    EXPECT_THAT(choice_of(content, scene::TechniqueId::bump).reason, HasSubstr("a terrain found"));
    EXPECT_FALSE(choice_of(content, scene::TechniqueId::bump).digit);
    EXPECT_EQ(choice_of(content, scene::TechniqueId::relief).reason, "");
    int digit = 0;
    for (const TechniqueChoice& choice : content.choices) {
        if (choice.digit) {
            EXPECT_EQ(*choice.digit, ++digit);
            editor.choose(static_cast<std::size_t>(digit - 1));
            EXPECT_EQ(changes.technique(), choice.technique);
        }
    }
}

TEST_F(TechniqueEditorTest, RefusesWhatCannotBeDrawnAndKeepsTheTechnique) {
    const scene::Technique before = shown();
    const auto refused = editor.request(scene::make_technique(scene::TechniqueId::bump));
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message, HasSubstr("technique bump"));
    EXPECT_EQ(changes.technique(), before);
}

TEST_F(TechniqueEditorTest, ATechniqueThatIsLeftKeepsItsParameters) {
    ASSERT_TRUE(editor.request(relief_with(40)));
    ASSERT_TRUE(editor.request(scene::Technique{scene::Texture{}}));
    EXPECT_EQ(shown().id(), scene::TechniqueId::texture);
    const TechniqueContent content = editor.content();
    EXPECT_EQ(choice_of(content, scene::TechniqueId::relief).technique, relief_with(40));
}

// A mesh that is seen from both sides, as the curtain is, has other techniques than a box.
TEST(TechniqueEditor, JudgesATechniqueForTheSelectedModelAlone) {
    const test::TemporaryFolder folder;
    session::Log silent;
    session::SourceOptions source;
    source.terrain = test::small_terrain(folder, "gallery");
    session::TerrainScene gallery = session::open_scene(source, {}, silent).value();
    AppearanceSwitch changes(gallery);
    TechniqueEditor editor(gallery, changes, gallery.materials().front()->technique);
    const auto reasons_of_all = [&] {
        std::vector<std::string> reasons;
        for (const TechniqueChoice& choice : editor.content().choices) {
            reasons.push_back(choice.reason);
        }
        return reasons;
    };
    const auto of_all = reasons_of_all();
    std::set<std::vector<std::string>> different;
    for (std::size_t model = 0; model < gallery.models.size(); ++model) {
        editor.select_model(model);
        const TechniqueContent content = editor.content();
        int digit = 0;
        for (const TechniqueChoice& choice : content.choices) {
            const auto good =
                scene::check_technique(scene::make_technique(choice.technique.id()),
                                       *gallery.models[model]->get<scene::MeshNode>());
            EXPECT_EQ(choice.reason, good ? "" : good.error().message);
            EXPECT_EQ(choice.digit.has_value(), good && digit < 9);
            digit += good ? 1 : 0;
        }
        different.insert(reasons_of_all());
    }
    EXPECT_GT(different.size(), 1U);
    editor.select_model({});
    EXPECT_EQ(reasons_of_all(), of_all);
}

TEST_F(TechniqueEditorTest, KeysChangeTheSelectedParameter) {
    ASSERT_TRUE(editor.request(relief_with(11)));
    editor.step_parameter(1);
    EXPECT_EQ(shown(), relief_with(12));
    editor.step_parameter(-2);
    EXPECT_EQ(shown(), relief_with(10));
    editor.select_next_parameter(1);
    EXPECT_EQ(editor.content().parameter, 1U);
    editor.step_parameter(1);
    EXPECT_EQ(std::get<scene::Relief>(shown().parameters).bisection_steps, 9);
    editor.select_next_parameter(1); // from the last to the first
    EXPECT_EQ(editor.content().parameter, 0U);
    ASSERT_TRUE(editor.request(scene::Technique{scene::Exact{}}));
    editor.step_parameter(1); // has none
    EXPECT_EQ(shown(), scene::Technique{scene::Exact{}});
}

TEST_F(TechniqueEditorTest, SaysWhichOptionsDoNotFit) {
    ASSERT_TRUE(editor.request(relief_with(11)));
    const std::vector<std::string> reasons = editor.content().option_reasons;
    const auto options = scene::option_catalogue();
    ASSERT_EQ(reasons.size(), options.size());
    for (std::size_t i = 0; i < options.size(); ++i) {
        scene::Technique with = relief_with(11);
        options[i].choose(with.options, options[i].words.empty() ? 0 : options[i].words.size() - 1);
        EXPECT_EQ(reasons[i].empty(), static_cast<bool>(scene.check(with))) << options[i].name;
    }
}

TEST(NumberSteps, StayAllowedAndReachBothEnds) {
    for (const scene::TechniqueInfo& info : scene::technique_catalogue()) {
        for (const scene::ParameterInfo& parameter : info.parameters) {
            for (const int direction : {-1, 1}) {
                double value = parameter.default_value;
                for (int i = 0; i < 5000; ++i) {
                    value = scene::stepped(parameter, value, direction);
                    ASSERT_TRUE(parameter.allows(value)) << parameter.name << ' ' << value;
                }
                EXPECT_EQ(value, direction > 0 ? parameter.high : parameter.low) << parameter.name;
            }
            for (const double odd : {-1e9, 1e9, 0.005, 0.4999, std::nan("")}) {
                EXPECT_TRUE(parameter.allows(scene::nearest_allowed(parameter, odd)));
            }
        }
    }
}

TEST(WithParameter, GivesATechniqueThatItsTextGivesBack) {
    for (const scene::TechniqueInfo& info : scene::technique_catalogue()) {
        scene::Technique technique = scene::make_technique(info.id);
        for (int round = 0; round < 2; ++round) {
            for (const scene::ParameterInfo& parameter : info.parameters) {
                technique = scene::with_parameter(technique, parameter, parameter.high);
                const auto read_back = scene::parse_technique(scene::to_string(technique));
                ASSERT_TRUE(read_back) << read_back.error().message;
                EXPECT_EQ(*read_back, technique);
            }
        }
    }
}

} // namespace
} // namespace reljef::app
