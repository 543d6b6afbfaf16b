#include "compile/light_groups.h"

#include <gtest/gtest.h>

#include "core/integrators/light_parts.h"
#include "util/diagnostics.h"

namespace alhazen::impl::test {

namespace {

using Names = std::vector<std::string>;

GroupedLights group_names(const Names& names, const std::vector<LightGroup>& groups) {
  return group_light_names(names, std::vector<bool>(names.size(), true), groups);
}

std::string refusal_of(const Names& texts) {
  try {
    parse_light_groups(texts);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(LightGroups, AreParsed) {
  const std::vector<LightGroup> groups = parse_light_groups({"key=sun,lamp *", "fill_2=a=b"});
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[0].name, "key");
  EXPECT_EQ(groups[0].patterns, (Names{"sun", "lamp *"}));
  EXPECT_EQ(groups[1].patterns, Names{"a=b"});
  for (const char* wrong : {"key", "key=", "=sun", "a b=sun", "key=sun,", "key=,sun", "k.R=sun", ""})
    EXPECT_NE(refusal_of({wrong}).find("must be NAME=LIGHT"), std::string::npos) << wrong;
  EXPECT_NE(refusal_of({"rest=sun"}).find("choose another name"), std::string::npos);
  EXPECT_NE(refusal_of({"a=sun", "a=moon"}).find("two light groups 'a'"), std::string::npos);
  Names many;
  for (uint32_t i = 0; i < max_light_groups; ++i) many.push_back("g" + std::to_string(i) + "=sun");
  EXPECT_NE(refusal_of(many).find("there may be 7"), std::string::npos);
  many.pop_back();
  EXPECT_EQ(refusal_of(many), "");
}

TEST(LightGroups, TakeTheFirstThatNamesALight) {
  const GroupedLights grouped =
      group_names({"sun", "lamp.1", "lamp.2", "sky"}, parse_light_groups({"b=lamp.2,sun", "a=lamp.?"}));
  EXPECT_EQ(grouped.groups, (Names{"b", "a", "rest"}));
  EXPECT_EQ(grouped.group_of, (std::vector<uint32_t>{0, 1, 0, 2}));
}

TEST(LightGroups, HaveNoRestWhereAllAreNamed) {
  EXPECT_EQ(group_names({"sun", "sky"}, parse_light_groups({"all=*"})).groups, Names{"all"});
}

TEST(LightGroups, NamesMayHaveBracketsAndBackslashes) {
  const GroupedLights grouped =
      group_names({"lamp[1]", "lamp1", "a\\b"}, parse_light_groups({"a=lamp[1]", "b=lamp1", "c=a\\b"}));
  EXPECT_EQ(grouped.group_of, (std::vector<uint32_t>{0, 1, 2}));
  EXPECT_EQ(grouped.groups, (Names{"a", "b", "c"}));
}

TEST(LightGroups, OfEachNameHavePlainOnes) {
  const GroupedLights grouped = group_names({"Light.001", "Light 001", "L\xc3\xa4mp"}, {});
  EXPECT_EQ(grouped.groups, (Names{"Light_001", "Light_001_2", "L__mp"}));
  EXPECT_EQ(grouped.group_of, (std::vector<uint32_t>{0, 1, 2}));
}

TEST(LightGroups, OfEachNameMayNotBeTooMany) {
  Names names;
  for (int i = 0; i < 9; ++i) names.push_back("lamp" + std::to_string(i));
  EXPECT_THROW(group_names(names, {}), InputError);
  names.pop_back();
  EXPECT_EQ(group_names(names, {}).groups, names);
}

TEST(LightGroups, QuestionMarksAreCharacters) {
  const GroupedLights grouped = group_names({"L\xc3\xa4mp", "Lamp", "Lp"}, parse_light_groups({"a=L?mp", "b=*p*"}));
  EXPECT_EQ(grouped.group_of, (std::vector<uint32_t>{0, 0, 1}));
  EXPECT_EQ(group_names({"abcabd", "ab"}, parse_light_groups({"a=*ab?", "b=a*b*"})).group_of,
            (std::vector<uint32_t>{0, 1}));
}

TEST(LightGroups, OfBlackLightsAreNone) {
  const GroupedLights by_name = group_light_names({"off", "sun"}, {false, true}, {});
  EXPECT_EQ(by_name.groups, Names{"sun"});
  EXPECT_EQ(by_name.group_of[1], 0u);
  const GroupedLights named =
      group_light_names({"off", "sun", "dark"}, {false, true, false}, parse_light_groups({"a=sun,off"}));
  EXPECT_EQ(named.groups, Names{"a"}) << "nothing that shines is left";
}

}  // namespace
}  // namespace alhazen::impl::test
