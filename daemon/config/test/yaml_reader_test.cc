// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/yaml_reader.h"

#include <gtest/gtest.h>

#include <time.h>

#include <array>
#include <cmath>
#include <fstream>

#include "daemon/config/daemon_config.h"
#include "daemon/config/settings.h"
#include "daemon/config/test/temporary_folder.h"
#include "gaitd/sdk/bounds.h"

namespace gaitd::daemon {
namespace {

MapReader read(const std::string& text, Issues* issues) {
  return MapReader(parse_yaml(text, "robot.yaml", issues), "", issues);
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(YamlReader, ReadsEveryType) {
  Issues issues;
  MapReader map = read(
      "number: -1.5e-3\nwhole: +7\nflag: true\nword: left\nname: abc\nlist: [1, 2, 3]\n"
      "quoted: '12'\nmap: {a: 1}\n",
      &issues);
  EXPECT_EQ(map.number("number", {-1.0, 1.0, "m"}), -1.5e-3);
  EXPECT_EQ(map.integer("whole", 0, 10), 7);
  EXPECT_EQ(map.boolean("flag"), true);
  constexpr std::array<std::string_view, 2> kWords = {"left", "right"};
  EXPECT_EQ(map.choice("word", kWords), 0);
  EXPECT_EQ(map.text("name"), "abc");
  EXPECT_EQ(map.text("quoted"), "12");
  std::array<double, 3> values{};
  EXPECT_TRUE(map.numbers("list", values));
  EXPECT_EQ(values[2], 3.0);
  MapReader inner = map.map("map");
  EXPECT_EQ(inner.number("a"), 1.0);
  inner.finish();
  EXPECT_FALSE(map.number("absent"));
  map.finish();
  EXPECT_TRUE(issues.ok()) << issues.error_text();
}

TEST(YamlReader, ReportsAllErrorsAtOnceWithLineAndPath) {
  Issues issues;
  MapReader map = read(
      "swing: quick\n"        // 1
      "transfer: 30\n"        // 2
      "steps: 2.5\n"          // 3
      "flag: yes\n"           // 4
      "side: lefft\n"         // 5
      "point: [1, two, 3]\n"  // 6
      "foot:\n"               // 7
      "  lenght: 1\n"         // 8
      "map: 3\n"              // 9
      "name: [a]\n",          // 10
      &issues);
  map.require({"schema"});
  map.number("swing");
  map.number("transfer", {0.05, 20.0, "s"});
  map.integer("steps", 1, 1000);
  map.boolean("flag");
  constexpr std::array<std::string_view, 2> kWords = {"left", "right"};
  map.choice("side", kWords);
  std::array<double, 3> values{};
  map.numbers("point", values);
  MapReader foot = map.map("foot");
  foot.number("length");
  foot.finish();
  map.map("map");
  map.text("name");
  map.finish();
  EXPECT_EQ(issues.error_text(),
            "robot.yaml:1: schema: expected a value, got nothing; add the key\n"
            "robot.yaml:1: swing: expected a number, got 'quick' (text); write a finite number\n"
            "robot.yaml:2: transfer: expected a number in 0.05..20 s, got 30; write one in that "
            "range\n"
            "robot.yaml:3: steps: expected a whole number in 1..1000, got 2.5; write one in that "
            "range\n"
            "robot.yaml:4: flag: expected true or false, got 'yes' (text); write one of the two\n"
            "robot.yaml:5: side: expected one of left, right, got 'lefft' (text); did you mean "
            "'left'?\n"
            "robot.yaml:6: point[1]: expected a number, got 'two' (text); write a finite number\n"
            "robot.yaml:8: foot.lenght: unknown key; did you mean 'length'?\n"
            "robot.yaml:9: map: expected a map of keys, got 3; write 'key: value' lines\n"
            "robot.yaml:10: name: expected a text, got a list of 1; write one");
}

TEST(YamlReader, SuggestsTheKeyThatIsMissing) {
  Issues issues;
  MapReader map = read("swing: 1\nswing_hight: 2\nfoo: 3\n", &issues);
  map.number("swing");
  map.number("swing_height");
  map.finish();
  EXPECT_TRUE(
      contains(issues.error_text(), "swing_hight: unknown key; did you mean 'swing_height'"));
  EXPECT_TRUE(contains(issues.error_text(), "foo: unknown key; known: swing, swing_height"));
}

TEST(YamlReader, ReportsDuplicateKeysWithBothLinesAndKeepsTheFirst) {
  Issues issues;
  MapReader map = read("a: 1\nb: 2\na: 3\n", &issues);
  EXPECT_EQ(issues.error_text(),
            "robot.yaml:3: a: the key is there twice, first in line 1; remove one of the two");
  EXPECT_EQ(map.number("a"), 1.0);
}

TEST(YamlReader, RefusesNumbersThatAreNotFinite) {
  for (const char* text :
       {".inf", "-.inf", ".nan", "inf", "nan", "1e999", "0x10", "1_000", "1.2.3"}) {
    Issues issues;
    MapReader map = read(std::string("a: ") + text + "\n", &issues);
    EXPECT_FALSE(map.number("a")) << text;
    EXPECT_FALSE(issues.ok()) << text;
  }
}

TEST(YamlReader, RefusesTextInQuotesAsANumber) {
  Issues issues;
  MapReader map = read("a: '1.0'\n", &issues);
  EXPECT_FALSE(map.number("a"));
}

TEST(YamlReader, ReportsSyntaxErrorsWithTheirLine) {
  Issues issues;
  EXPECT_EQ(parse_yaml("a: 1\nb: [1, 2\nc: 3\n", "x.yaml", &issues), nullptr);
  EXPECT_TRUE(contains(issues.error_text(), "x.yaml:")) << issues.error_text();
  EXPECT_TRUE(contains(issues.error_text(), "not YAML")) << issues.error_text();
}

TEST(YamlReader, RefusesDeepNesting) {
  for (const std::string unit : {"[", "{a: ", "- "}) {
    std::string text;
    for (int i = 0; i < 2000; ++i) text += unit;
    Issues issues;
    EXPECT_EQ(parse_yaml(text, "x.yaml", &issues), nullptr);
    EXPECT_TRUE(contains(issues.error_text(), "32 levels")) << issues.error_text();
  }
}

TEST(YamlReader, RefusesAliasBombs) {
  std::string text = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 12; ++i) {
    const std::string before = "*a" + std::to_string(i - 1);
    text += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + before;
    for (int j = 0; j < 9; ++j) text += ", " + before;
    text += "]\n";
  }
  Issues issues;
  EXPECT_EQ(parse_yaml(text, "x.yaml", &issues), nullptr);
  EXPECT_TRUE(contains(issues.error_text(), "every alias expanded")) << issues.error_text();
}

TEST(YamlReader, RefusesAnAliasInsideItsOwnValue) {
  Issues issues;
  EXPECT_EQ(parse_yaml("a: &a [1, *a]\n", "x.yaml", &issues), nullptr);
  EXPECT_TRUE(contains(issues.error_text(), "contains it")) << issues.error_text();
}

TEST(YamlReader, AcceptsAnAliasOfALinesWorth) {
  Issues issues;
  MapReader map = read("a: &p [1, 2]\nb: *p\n", &issues);
  std::array<double, 2> values{};
  EXPECT_TRUE(map.numbers("b", values));
  EXPECT_EQ(values[1], 2.0);
  EXPECT_TRUE(issues.ok()) << issues.error_text();
}

TEST(YamlReader, RefusesLargeTextsSeveralDocumentsTagsAndOddKeys) {
  Issues large;
  EXPECT_EQ(parse_yaml(std::string(bounds::kYamlBytes + 1, ' '), "x.yaml", &large), nullptr);
  EXPECT_TRUE(contains(large.error_text(), "1048576 bytes"));

  Issues several;
  EXPECT_EQ(parse_yaml("a: 1\n---\nb: 2\n", "x.yaml", &several), nullptr);
  EXPECT_TRUE(contains(several.error_text(), "one YAML document")) << several.error_text();

  Issues tags;
  parse_yaml("a: !!python/object:os.system x\n", "x.yaml", &tags);
  EXPECT_TRUE(contains(tags.error_text(), "without a tag")) << tags.error_text();

  Issues keys;
  parse_yaml("[1, 2]: 3\n", "x.yaml", &keys);
  EXPECT_TRUE(contains(keys.error_text(), "a key of one word")) << keys.error_text();

  Issues empty;
  EXPECT_EQ(parse_yaml("# nothing\n", "x.yaml", &empty), nullptr);
  EXPECT_TRUE(contains(empty.error_text(), "a YAML document")) << empty.error_text();
}

TEST(YamlReader, RefusesWhatIsNoText) {
  const std::string head = "schema: x\nname: ";
  for (const std::string bytes :
       {std::string("\0", 1), std::string("\4"), std::string("\x7f"), std::string("\xff\xfe"),
        std::string("\xc0\x80"), std::string("\xed\xa0\x80"), std::string("\xe2\x82"),
        std::string("\xf4\x90\x80\x80"), std::string("caf\xe9")}) {
    Issues issues;
    EXPECT_EQ(parse_yaml(head + bytes, "x.yaml", &issues), nullptr);
    EXPECT_TRUE(contains(issues.error_text(), "x.yaml:2: expected text in UTF-8, got the byte 0x"))
        << issues.error_text();
  }
  Issues issues;
  EXPECT_EQ(
      read("name: gr\xc3\xb6\xc3\x9f\xe2\x82\xac\xf0\x9f\xa4\x96\t\r\n", &issues).text("name"),
      "gr\xc3\xb6\xc3\x9f\xe2\x82\xac\xf0\x9f\xa4\x96");
  EXPECT_TRUE(issues.ok()) << issues.error_text();
}

std::string repeated(const std::string& unit, std::size_t bytes) {
  std::string text;
  while (text.size() + unit.size() <= bytes) text += unit;
  return text;
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr double kSoon = 60.0;  // s of the processor
#else
constexpr double kSoon = 3.0;  // s of the processor
#endif

// s of this thread's processor.
double processor_time() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// Whatever is in a file of the largest size. 4 MB of keys took 41 s while each was compared with
// all others.
TEST(YamlReader, ReadsOrRefusesAnythingSoon) {
  const std::size_t bytes = bounds::kYamlBytes;
  std::string keys;
  for (int i = 0; keys.size() + 16 < bytes; ++i) keys += "k" + std::to_string(i) + ": 1\n";
  std::string anchors;
  for (int i = 0; anchors.size() + 20 < bytes; ++i) anchors += "- &a" + std::to_string(i) + " 1\n";
  std::string deep;
  for (int i = 0; deep.size() + 40 < bytes; ++i) deep += std::string(i % 30, ' ') + "a:\n";
  const std::vector<std::string> texts = {
      keys,
      anchors,
      deep,
      repeated("a: 1\n", bytes),
      repeated("- 1\n", bytes),
      repeated("- - - -\n", bytes),
      "[" + repeated("a,", bytes - 1),
      "{" + repeated("a: b,", bytes - 1),
      "{" + repeated("a,", bytes - 1),
      repeated("[", bytes),
      repeated("{a: ", bytes),
      repeated("? ", bytes),
      repeated("? a\n", bytes),
      repeated("- ? a\n", bytes),
      repeated("a", bytes),
      repeated("a b\n", bytes),
      repeated("a:a:", bytes),
      repeated(": ", bytes),
      repeated("\n", bytes),
      repeated("# x\n", bytes),
      repeated("&a ", bytes),
      repeated("!t ", bytes),
      repeated("*a ", bytes),
      repeated("--- ", bytes),
      repeated("%a\n", bytes),
      repeated("a: |\n b\n", bytes),
      "a: |\n" + repeated(" b\n", bytes - 10),
      "a: >\n" + repeated(" b\n\n", bytes - 10),
      "\"" + repeated("\\x41", bytes - 1),
      "\"" + repeated("\n", bytes - 1),
      "'" + repeated("''", bytes - 1),
      "a: &a [x]\nb: [" + repeated("*a,", bytes - 20) + "]\n",
  };
  for (const std::string& text : texts) {
    ASSERT_LE(text.size(), bytes);
    const double began = processor_time();
    Issues issues;
    const NodePtr root = parse_yaml(text, "x.yaml", &issues);
    EXPECT_TRUE(root || !issues.ok()) << text.substr(0, 20);
    if (root && root->kind == NodeKind::kMap) {
      Settings settings;
      settings.set_tree(SettingSource::kConfig, *root, &issues);
      read_daemon_config(&settings, &issues);
      settings.report_unknown(&issues);
      MapReader(root, "", &issues).finish();
    }
    issues.error_text();
    EXPECT_LT(processor_time() - began, kSoon) << text.substr(0, 20);
  }
}

TEST(YamlReader, RefusesLongKeysAndManySettings) {
  Issues longer;
  EXPECT_EQ(parse_yaml(std::string(bounds::kYamlKey + 1, 'k') + ": 1\n", "x.yaml", &longer),
            nullptr);
  EXPECT_TRUE(contains(longer.error_text(), "x.yaml:1: expected a key of at most 256 characters"))
      << longer.error_text();
  EXPECT_NE(parse_yaml(std::string(bounds::kYamlKey, 'k') + ": 1\n", "x.yaml", &longer), nullptr);

  std::string many;
  for (std::size_t i = 0; i <= bounds::kSettings; ++i) many += "k" + std::to_string(i) + ": 1\n";
  Issues issues;
  Settings settings;
  settings.set_tree(SettingSource::kConfig, *parse_yaml(many, "x.yaml", &issues), &issues);
  EXPECT_EQ(issues.error_count(), 1u);
  EXPECT_TRUE(contains(issues.error_text(), "at most 2000 settings")) << issues.error_text();

  std::string dots = "k";
  while (dots.size() <= bounds::kYamlKey) dots += ".k";
  Issues dotted;
  Settings().set_assignment(dots + "=1", &dotted);
  EXPECT_TRUE(contains(dotted.error_text(), "keys of at most 256 characters"));
}

TEST(YamlReader, RefusesAnEndlessStream) {
  Issues issues;
  std::ifstream zeros("/dev/zero");
  EXPECT_EQ(read_yaml(zeros, "standard input", &issues), nullptr);
  EXPECT_TRUE(contains(issues.error_text(), "standard input: expected at most 1048576 bytes"));
}

TEST(YamlReader, RefusesTabsAsIndentation) {
  Issues issues;
  EXPECT_EQ(parse_yaml("a:\n\tb: 1\n", "x.yaml", &issues), nullptr);
  EXPECT_TRUE(contains(issues.error_text(), "x.yaml:2: ")) << issues.error_text();
}

TEST(YamlReader, RefusesWhatIsNoFile) {
  const TemporaryFolder folder;
  Issues directory;
  EXPECT_EQ(load_yaml_file(folder.path().string(), &directory), nullptr);
  EXPECT_TRUE(contains(directory.error_text(), "expected a file, got something else"));
  Issues device;
  EXPECT_EQ(load_yaml_file("/dev/zero", &device), nullptr);
  EXPECT_TRUE(contains(device.error_text(), "expected a file, got something else"));
  const std::string large = folder.write("large.yaml", "a: 1\n");
  std::filesystem::resize_file(large, bounds::kYamlBytes + 1);
  Issues size;
  EXPECT_EQ(load_yaml_file(large, &size), nullptr);
  EXPECT_TRUE(contains(size.error_text(), "expected at most 1048576 bytes, got 1048577"));
}

TEST(YamlReader, SaysThatAFileIsNotThere) {
  Issues issues;
  EXPECT_EQ(load_yaml_file("/nowhere/at/all.yaml", &issues), nullptr);
  EXPECT_EQ(issues.error_text(),
            "/nowhere/at/all.yaml: expected a file, got nothing there; correct the path");
}

TEST(Issues, AreSortedByLineAndShortenedAfterAHundred) {
  Issues issues;
  for (int line = 250; line > 0; --line) issues.add_text({"f", line}, "k", "bad");
  EXPECT_EQ(issues.error_text().substr(0, 9), "f:1: k: b");
  EXPECT_TRUE(contains(issues.error_text(), "... and 150 more"));
  EXPECT_EQ(issues.error_count(), 250u);
}

TEST(Polygons, MustBeConvexAndCounterClockwise) {
  std::string why;
  const std::vector<double> square = {0, 0, 1, 0, 1, 1, 0, 1};
  EXPECT_TRUE(is_convex_counter_clockwise(square, 2, &why)) << why;
  const std::vector<double> clockwise = {0, 0, 0, 1, 1, 1, 1, 0};
  EXPECT_FALSE(is_convex_counter_clockwise(clockwise, 2, &why));
  EXPECT_TRUE(contains(why, "clockwise"));
  const std::vector<double> dented = {0, 0, 1, 0, 0.2, 0.2, 0, 1};
  EXPECT_FALSE(is_convex_counter_clockwise(dented, 2, &why));
  EXPECT_TRUE(contains(why, "inwards at point 2")) << why;
  const std::vector<double> line = {0, 0, 1, 0, 2, 0};
  EXPECT_FALSE(is_convex_counter_clockwise(line, 2, &why));
  EXPECT_TRUE(contains(why, "no area"));
  // A pentagram turns left at every corner, twice around.
  std::vector<double> star;
  for (int i = 0; i < 5; ++i) {
    star.push_back(std::cos(i * 4.0 * M_PI / 5.0));
    star.push_back(std::sin(i * 4.0 * M_PI / 5.0));
  }
  EXPECT_FALSE(is_convex_counter_clockwise(star, 2, &why));
  EXPECT_TRUE(contains(why, "crosses itself")) << why;
}

}  // namespace
}  // namespace gaitd::daemon
