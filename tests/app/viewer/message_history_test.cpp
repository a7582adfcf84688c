#include "app/viewer/message_history.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace reljef::app {
namespace {

struct Console : session::Log {
    void message(session::MessageKind /*kind*/, std::string_view sentence) override {
        sentences.emplace_back(sentence);
    }
    std::vector<std::string> sentences;
};

std::vector<std::string> texts_of(const MessageHistory& history) {
    std::vector<std::string> texts;
    for (const MessageContent& message : history.messages()) {
        texts.push_back(message.text);
    }
    return texts;
}

TEST(MessageHistory, ResultsAreWrittenAndShown) {
    Console console;
    MessageHistory history(console);
    testing::internal::CaptureStdout();
    history.report("");
    history.report("saved a.png\n");
    history.report("1  x 3 m\n2  x 4 m\n  distance 1 m\n  in sight\nsaved b.png\n");
    history.report("no end");
    EXPECT_EQ(testing::internal::GetCapturedStdout(),
              "saved a.png\n1  x 3 m\n2  x 4 m\n  distance 1 m\n  in sight\nsaved b.png\nno end");
    EXPECT_THAT(texts_of(history), testing::ElementsAre("saved a.png", "1  x 3 m",
                                                        "2  x 4 m\n  distance 1 m\n  in sight",
                                                        "saved b.png", "no end"));
    EXPECT_TRUE(console.sentences.empty()) << "results are for standard output";
}

TEST(MessageHistory, NotesAndErrorsArePassedOnAndShown) {
    Console console;
    MessageHistory history(console);
    history.note("a note");
    history.message(session::MessageKind::left_out, "b.tif: cannot be read");
    EXPECT_THAT(console.sentences, testing::ElementsAre("a note", "b.tif: cannot be read"));
    EXPECT_EQ(texts_of(history), console.sentences);
    EXPECT_FALSE(history.messages()[0].is_error);
    EXPECT_TRUE(history.messages()[1].is_error);
    EXPECT_LT(history.youngest(), message_seconds);
}

TEST(MessageHistory, KeepsTheLatest) {
    Console console;
    MessageHistory history(console);
    for (std::size_t i = 0; i < MessageHistory::max_messages + 5; ++i) {
        history.note(std::to_string(i));
    }
    EXPECT_EQ(history.messages().size(), MessageHistory::max_messages);
    EXPECT_EQ(history.messages().front().text, "5");
}

} // namespace
} // namespace reljef::app
