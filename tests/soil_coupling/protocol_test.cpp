// SPDX-License-Identifier: MIT
// The conversation alone, and the layout that both languages must share. No process but /usr/bin/python3 printing its
// view.
#include "soil_coupling/protocol.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "root_sph/core/errors.hpp"
#include "soil_coupling/channel.hpp"

namespace rootsoil {
namespace {

constexpr Kind requests[] = {Kind::hello,    Kind::pack, Kind::build, Kind::advance,
                             Kind::snapshot, Kind::save, Kind::load,  Kind::stop};

Packet answer_to(const Packet& request, Kind kind = Kind::done) {
  Packet answer = request;
  answer.kind = kind;
  return answer;
}

/// A conversation that has come to a state.
Protocol protocol_in(SoilState state) {
  Protocol p;
  if (state == SoilState::created) return p;
  p.accept(answer_to(p.begin(Kind::hello)));
  if (state == SoilState::greeted) return p;
  p.accept(answer_to(p.begin(Kind::build)));
  if (state == SoilState::waiting) p.begin(Kind::advance);
  if (state == SoilState::stopped) p.begin(Kind::stop);
  if (state == SoilState::failed) p.fail();
  return p;
}

TEST(Protocol, AllowsInEachStateWhatTheDrawingSays) {
  using enum SoilState;
  const std::pair<SoilState, std::vector<Kind>> table[] = {
      {created, {Kind::hello, Kind::stop}},
      {greeted, {Kind::pack, Kind::build, Kind::load, Kind::stop}},
      {ready, {Kind::advance, Kind::snapshot, Kind::save, Kind::load, Kind::stop}},
      {waiting, {}},
      {stopped, {}},
      {failed, {}}};
  for (const auto& [state, allowed] : table) {
    Protocol p = protocol_in(state);
    ASSERT_EQ(p.state(), state);
    for (const Kind request : requests) {
      const bool expected = std::find(allowed.begin(), allowed.end(), request) != allowed.end();
      EXPECT_EQ(p.allows(request), expected) << name_of(request) << " when " << name_of(state);
      if (!expected) {
        EXPECT_THROW(p.begin(request), std::logic_error);
      }
    }
  }
}

TEST(Protocol, NumbersRequestsAndWaitsThroughProgress) {
  Protocol p = protocol_in(SoilState::ready);
  const Packet first = p.begin(Kind::advance);
  EXPECT_EQ(p.state(), SoilState::waiting);
  EXPECT_FALSE(p.accept(answer_to(first, Kind::progress)));
  EXPECT_EQ(p.state(), SoilState::waiting);
  EXPECT_TRUE(p.accept(answer_to(first)));
  EXPECT_EQ(p.begin(Kind::save).sequence, first.sequence + 1);
}

TEST(Protocol, NothingFollowsAFailure) {
  for (const Kind kind : {Kind::failed, Kind::refused}) {
    Protocol p = protocol_in(SoilState::ready);
    EXPECT_TRUE(p.accept(answer_to(p.begin(Kind::advance), kind)));
    EXPECT_EQ(p.state(), SoilState::failed);
  }
}

TEST(Protocol, ABrokenAnswerIsAnErrorWithTheReason) {
  const std::pair<void (*)(Packet&), const char*> cases[] = {
      {[](Packet& a) { a.magic = 1; }, "begins with 0x1"},
      {[](Packet& a) { a.version = 9; }, "speaks version 9"},
      {[](Packet& a) { a.sequence -= 1; }, "while message 3 was open"},
      {[](Packet& a) { a.kind = Kind::build; }, "'build' is no answer"},
      {[](Packet& a) { a.text_bytes = text_room + 1; }, "a text of 65537 bytes"}};
  for (const auto& [spoil, words] : cases) {
    Protocol p = protocol_in(SoilState::ready);
    Packet answer = answer_to(p.begin(Kind::advance));
    spoil(answer);
    try {
      p.accept(answer);
      ADD_FAILURE() << words;
    } catch (const SoilError& e) {
      EXPECT_THAT(e.what(), testing::HasSubstr(words));
      EXPECT_EQ(e.status(), ExitStatus::soil_failed);
    }
    EXPECT_EQ(p.state(), SoilState::failed);
  }
  Protocol idle = protocol_in(SoilState::ready);
  EXPECT_THROW(idle.accept(Packet{}), SoilError);
}

TEST(Message, BothLanguagesHaveTheSameLayout) {
  FILE* pipe = popen("/usr/bin/python3 -I " ROOTSOIL_SOURCE_DIR "/soil_coupling/yade_side/message.py", "r");
  ASSERT_NE(pipe, nullptr);
  std::string text;
  std::array<char, 4096> part;
  while (std::fgets(part.data(), part.size(), pipe)) text += part.data();
  ASSERT_EQ(pclose(pipe), 0);
  EXPECT_EQ(nlohmann::json::parse(text), nlohmann::json::parse(describe_layout()));
}

TEST(Message, ColumnsFollowEachOtherWithoutOverlap) {
  const std::size_t rows = 13;
  for (std::size_t k = 0; k < motion_table.size(); ++k) {
    const std::size_t begin = column_offset(motion_table, k, rows), next = column_offset(motion_table, k + 1, rows);
    EXPECT_EQ(begin % column_alignment, 0u);
    EXPECT_GE(next - begin, 8 * motion_table[k].components * rows);
  }
}

TEST(Channel, TheBlockGrowsAndKeepsWhatIsInIt) {
  SharedBlock block(100);
  EXPECT_EQ(block.size(), text_room);
  block.write_text("what was said");
  block.grow(50 * text_room);
  EXPECT_GE(block.size(), 50 * text_room);
  EXPECT_EQ(block.text(13), "what was said");
  block.column<double>(motion_table, 1, 1000).back() = 4.0;
  EXPECT_EQ(block.column<double>(motion_table, 1, 1000).back(), 4.0);
  EXPECT_THROW(block.write_text(std::string(text_room + 1, 'x')), SoilError);
  EXPECT_THROW(block.follow(2 * block.size()), SoilError) << "a size that nobody made";
}

}  // namespace
}  // namespace rootsoil
