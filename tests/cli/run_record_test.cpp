// Recordings of `ist run`: whole whatever ends the run, and made again to the same bytes.

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "cli/recordings/tick_lines.h"
#include "cli/run_case.h"
#include "ist/scene.h"
#include "support/effort.h"

namespace ist::test {
namespace {

class RunRecord : public RunCase {};

constexpr const char* kRest = R"(unit = "mm"
[fixed]
shape = "box"
size = [20, 20, 4]
[held]
shape = "box"
size = [4, 6, 4]
translation = [0, 0, 5]
[device]
kind = "hand"
plan = [{ time = 0, move = [0, 0, 0] }, { time = 0.5, move = [0, 0, -3] }, { time = 1, move = [0, 0, -3] }]
[effects.contact]
)";

// Without the three times at its end, which differ from run to run.
std::string without_times(const std::string& text) {
  std::string result;
  for (const std::string& line : lines_of(text)) {
    const std::size_t at = line.find(",\"late_microseconds\":");
    // Neither the header nor a change of the hand has times.
    const bool is_tick = !result.empty() && line.find("\"status\"") == std::string::npos;
    EXPECT_EQ(at != std::string::npos, is_tick) << line;
    result += line.substr(0, at) + '\n';
  }
  return result;
}

std::vector<std::string> cells(const std::string& row) {
  std::vector<std::string> parts;
  std::istringstream stream(row + ",");
  for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
  return parts;
}

TEST_F(RunRecord, RecordsEveryTickAsJsonLines) {
  const std::string file = path("ticks.jsonl");
  ist_well(run(all_effects(), {"--unpaced", "--record", file}));
  const auto lines = json_lines(file_content(file));
  ASSERT_GE(lines.size(), 600u);  // the plan's end ends it
  ASSERT_LT(lines.size(), 605u);
  const std::vector<std::string> keys{"tick",
                                      "dt",
                                      "device",
                                      "tool",
                                      "wrench",
                                      "contacts",
                                      "leaf_pairs",
                                      "complete",
                                      "proximity_complete",
                                      "held",
                                      "fault",
                                      "steps",
                                      "halved",
                                      "points",
                                      "late_microseconds",
                                      "microseconds",
                                      "cpu_microseconds"};
  double force = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    EXPECT_EQ(lines[i].size(), keys.size());
    for (const std::string& key : keys) ASSERT_TRUE(lines[i].contains(key)) << key;
    EXPECT_EQ(lines[i]["tick"], i);
    EXPECT_EQ(lines[i]["device"].size(), 12u);
    EXPECT_EQ(lines[i]["wrench"].size(), 6u);
    EXPECT_EQ(lines[i]["complete"], true);
    force = std::max(force, std::abs(lines[i]["wrench"][2].get<double>()));
  }
  EXPECT_GT(force, 0.5);
}

TEST_F(RunRecord, RecordsTheSameNumbersAsCsv) {
  const std::string scene = shipped("press"), lines = path("a.jsonl"), csv = path("a.csv");
  ist_well(run(scene, {"--unpaced", "--seconds", "1", "--record", lines}));
  ist_well(run(scene, {"--unpaced", "--seconds", "1", "--record", csv}));
  const auto objects = json_lines(file_content(lines));
  const std::vector<std::string> rows = lines_of(file_content(csv));
  ASSERT_EQ(rows.size(), objects.size() + 1);
  const std::vector<std::string> header = cells(rows[0]);
  EXPECT_EQ(header.size(), 42u + 6 + 6 * 14);
  EXPECT_EQ(std::set<std::string>(header.begin(), header.end()).size(), header.size());
  const auto column = [&](const char* name) {
    const auto found = std::find(header.begin(), header.end(), name);
    EXPECT_NE(found, header.end()) << name;
    return static_cast<std::size_t>(found - header.begin());
  };
  const std::size_t z = column("tool_z"), force = column("force_z"), turn = column("device_zz"),
                    contacts = column("contacts"), complete = column("complete"),
                    near = column("proximity_complete"), pairs = column("leaf_pairs");
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const std::vector<std::string> row = cells(rows[i + 1]);
    ASSERT_EQ(row.size(), header.size());
    EXPECT_EQ(row[0], std::to_string(i));
    EXPECT_EQ(std::stod(row[z]), objects[i]["tool"][2].get<double>());
    EXPECT_EQ(std::stod(row[force]), objects[i]["wrench"][2].get<double>());
    EXPECT_EQ(std::stod(row[turn]), objects[i]["device"][11].get<double>());
    EXPECT_EQ(std::stoull(row[contacts]), objects[i]["contacts"].get<std::uint64_t>());
    EXPECT_EQ(std::stod(row[pairs]), objects[i]["leaf_pairs"].get<double>());
    EXPECT_EQ(row[complete], objects[i]["complete"].get<bool>() ? "1" : "0");
    EXPECT_TRUE(row[near].empty());  // nothing asks for it
  }
}

// A file of ticks that a test made, for a scene of two bodies.
class TickFile : public RunRecord {
 protected:
  [[nodiscard]] cli::RecordingHeader header() const {
    return cli::RecordingHeader(scene_, *built_.simulation);
  }
  [[nodiscard]] std::string written(const std::string& name,
                                    const std::vector<TickRecord>& ticks) const {
    cli::TickWriter writer(path(name), header());
    for (const TickRecord& tick : ticks) writer.write(tick);
    writer.commit();
    return path(name);
  }
  // A tick in contact, with numbers that no rounding keeps.
  [[nodiscard]] TickRecord touching(std::uint64_t number, std::uint32_t points) const {
    const Placement start = built_.simulation->tool_pose();
    TickRecord record{};
    record.tick = number;
    record.dt = built_.simulation->dt();
    record.device = record.tool = to_numbers(start);
    record.device_known = true;
    record.contacts = QueryResult{};
    record.steps = 2;
    record.point_count = points;
    for (std::uint32_t i = 0; i < points; ++i) {
      const double x = 0.1 + i;
      record.points[i] = {{x / 3, -x / 7, 1e-20 / x},
                          {0, 0.6, -0.8},
                          {x, 2 * x, 3.5},
                          5e-6 / x,
                          4000000000U + i,
                          7 * i,
                          i % 2,
                          2};
    }
    return record;
  }

  const Scene scene_ = read_scene(boxes());
  const BuiltScene built_ = build_scene(scene_);
};

TEST_F(TickFile, HasEachContactPointWithAllItsDigits) {
  const std::vector<TickRecord> ticks{touching(0, 0), touching(1, 1), touching(2, 6)};
  const auto lines = json_lines(file_content(written("a.jsonl", ticks)));
  const std::vector<std::string> rows = lines_of(file_content(written("a.csv", ticks)));
  ASSERT_EQ(lines.size(), 3u);
  ASSERT_EQ(rows.size(), 4u);
  const std::vector<std::string> names = cells(rows[0]);
  for (std::size_t t = 0; t < 3; ++t) {
    const nlohmann::json& points = lines[t]["points"];
    EXPECT_EQ(lines[t]["steps"], 2);
    EXPECT_EQ(lines[t]["halved"], false);
    ASSERT_EQ(points.size(), ticks[t].point_count);
    std::map<std::string, std::string> row;
    const std::vector<std::string> values = cells(rows[t + 1]);
    ASSERT_EQ(values.size(), names.size());
    for (std::size_t i = 0; i < names.size(); ++i) row[names[i]] = values[i];
    EXPECT_EQ(row["points"], std::to_string(points.size()));
    double sum = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const ContactRecord& point = ticks[t].points[i];
      EXPECT_EQ(points[i],
                (nlohmann::json{{"position", point.position},
                                {"normal", point.normal},
                                {"force", point.force},
                                {"gap", point.gap},
                                {"triangles", {point.fixed_triangle, point.held_triangle}},
                                {"bodies", {point.fixed, point.held}}}));
      const std::string name = fmt::format("point{}_", i + 1);
      EXPECT_EQ(std::stod(row[name + "x"]), point.position[0]);
      EXPECT_EQ(std::stod(row[name + "normal_z"]), point.normal[2]);
      EXPECT_EQ(std::stod(row[name + "force_y"]), point.force[1]);
      EXPECT_EQ(std::stod(row[name + "gap"]), point.gap);
      EXPECT_EQ(row[name + "triangle_fixed"], std::to_string(point.fixed_triangle));
      EXPECT_EQ(row[name + "body_held"], "2");
      sum += point.force[1];
    }
    EXPECT_EQ(std::stod(row["points_force_y"]), sum);
    EXPECT_EQ(row["point6_x"].empty(), points.size() < 6);
    EXPECT_EQ(row["point6_body_held"].empty(), points.size() < 6);
    EXPECT_EQ(row["cpu_microseconds"], "0");
  }
}

// A tick that was held makes its steps again. With none, its query ends as it did.
TEST_F(TickFile, ReplayLimitsHeldTicksAlone) {
  std::vector<TickRecord> ticks{touching(0, 1), touching(1, 1), touching(2, 0), touching(3, 0)};
  ticks[1].held = true;
  ticks[1].contacts->complete = false;
  ticks[2].held = true;
  ticks[2].contacts->complete = false;
  ticks[2].steps = 0;
  ticks[3].contacts.reset();
  ticks[3].proximity = QueryResult{};
  ticks[3].proximity->complete = false;
  cli::TickReader reader(written("a.jsonl", ticks), header());
  const std::atomic<bool> stop{false};
  const auto budget = [&] {
    const std::optional<RecordedTick> tick = reader.next(stop);
    EXPECT_TRUE(tick);
    return tick ? tick->budget : TickBudget{};
  };
  const TickBudget whole = budget(), held = budget(), none = budget(), near = budget();
  EXPECT_EQ(whole.steps, TickBudget{}.steps);
  EXPECT_FALSE(whole.contacts.has_tests());
  EXPECT_EQ(held.steps, 2);
  EXPECT_FALSE(held.contacts.has_tests());
  EXPECT_EQ(none.steps, 0);
  EXPECT_TRUE(none.contacts.has_tests());
  EXPECT_EQ(none.contacts.tests, 0u);
  EXPECT_EQ(near.steps, TickBudget{}.steps);
  EXPECT_FALSE(near.contacts.has_tests());
  EXPECT_EQ(near.proximity.tests, 0u);
  EXPECT_FALSE(reader.next(stop));
}

TEST_F(RunRecord, ReplayGivesTheSameBytes) {
  for (const std::string& scene : {shipped("slide"), all_effects()}) {
    const std::string first = path("first.jsonl"), again = path("again.jsonl");
    ist_well(run(scene, {"--unpaced", "--seconds", "0.6", "--record", first}));
    const CommandResult result = ist_well(run(scene, {"--replay", first, "--record", again}));
    EXPECT_TRUE(says(result.err, "replayed 600 ticks"));
    EXPECT_TRUE(without_times(file_content(again)) == without_times(file_content(first)));
  }
}

// The recording tells which ticks the clock stopped: here each fourth tick in contact.
TEST_F(RunRecord, ReplayOfARunThatWasStoppedGivesTheSameBytes) {
  IST_SLOW();
  for (const bool contact : {false, true}) {  // or springs
    const std::string scene = contact ? boxes() : all_effects();
    const std::string whole = path("whole.jsonl"), first = path("first.jsonl"),
                      again = path("again.jsonl");
    ist_well(run(scene, {"--unpaced", "--seconds", "2", "--record", whole}));
    std::string text;
    for (const std::string& line : lines_of(file_content(whole))) {
      const nlohmann::json tick = nlohmann::json::parse(line);
      const bool stopped = tick.contains("tick") && tick["tick"].get<int>() % 4 == 0 &&
                           (tick["contacts"].get<int>() > 0 || !tick["points"].empty());
      if (stopped) {
        // The clock stopped each second one after its first step.
        const int made = tick["steps"].get<int>();
        const int before = tick["tick"].get<int>() % 8 == 0 && made > 1 ? 1 : 0;
        text += replaced(replaced(replaced(line, "\"complete\":true", "\"complete\":false"),
                                  "\"held\":false", "\"held\":true"),
                         fmt::format("\"steps\":{},", made), fmt::format("\"steps\":{},", before));
      } else {
        text += line;
      }
      text += '\n';
    }
    const std::string stopped = write("stopped.jsonl", text);
    ist_well(run(scene, {"--replay", stopped, "--record", first}));
    ist_well(run(scene, {"--replay", first, "--record", again}));
    const std::string recorded = file_content(first);
    std::set<std::pair<bool, int>> held;  // and the steps
    for (const auto& line : json_lines(recorded)) {
      if (line.contains("held")) held.emplace(line["held"].get<bool>(), line["steps"].get<int>());
    }
    EXPECT_TRUE(held.contains({true, 0})) << "no tick was held";
    if (contact) {
      EXPECT_TRUE(held.contains({true, 1})) << "none after its first step";
    }
    EXPECT_FALSE(held.begin()->first) << "every tick was";
    EXPECT_TRUE(without_times(file_content(again)) == without_times(recorded));
  }
}

// A box rests on a plate, and the hand presses it: the contacts bear the hand. The report says the
// same as the ticks.
TEST_F(RunRecord, ContactPointsBearTheForceOnTheHand) {
  const std::string scene = write("rest.toml", kRest);
  const std::string file = path("ticks.jsonl");
  const CommandResult result = ist_well(run(scene, {"--unpaced", "--record", file, "--json"}));
  const nlohmann::json report = json_lines(result.out).back();
  const auto lines = json_lines(file_content(file));
  std::uint64_t in_contact = 0, held = 0, halved = 0;
  std::size_t most = 0;
  double largest = 0;
  for (const auto& tick : lines) {
    const auto& points = tick["points"];
    in_contact += points.empty() ? 0U : 1U;
    held += tick["held"].get<bool>() ? 1U : 0U;
    halved += tick["halved"].get<bool>() ? 1U : 0U;
    most = std::max(most, points.size());
    for (const auto& point : points) {
      EXPECT_EQ(point["bodies"], (nlohmann::json{0, 1}));
      EXPECT_NEAR(point["normal"][2].get<double>(), 1, 1e-9);
      EXPECT_NEAR(point["position"][2].get<double>(), 2e-3, 1e-9);
      const auto force = point["force"].get<std::array<double, 3>>();
      largest = std::max(
          largest, std::sqrt(force[0] * force[0] + force[1] * force[1] + force[2] * force[2]));
    }
    EXPECT_LE(tick["steps"], 3);
  }
  EXPECT_GT(in_contact, 500u);
  EXPECT_EQ(report["in_contact"], in_contact);
  EXPECT_EQ(report["most_points"], most);
  EXPECT_EQ(report["largest_point_force"], largest);
  EXPECT_EQ(report["held"], held);
  EXPECT_EQ(report["halved"], halved);
  const auto& last = lines.back();
  double force = 0;
  for (const auto& point : last["points"]) force += point["force"][2].get<double>();
  EXPECT_GT(force, 0.5);
  EXPECT_NEAR(last["wrench"][2].get<double>(), force, 1e-3 * force);

  const std::string said = ist_well(run(scene, {"--unpaced"})).out;
  EXPECT_TRUE(says(said, fmt::format("contact points: {} ticks with any, at most {} at once, at "
                                     "most {:.3g} N at one; {} ticks halved",
                                     in_contact, most, largest, halved)));
}

// Each triangle of the plate is a tooth of its own, and all triangles of the box are one tooth.
TEST_F(RunRecord, ForcesOnTeethAreSumsOverTheirTriangles) {
  const std::string scene = write("rest.toml", kRest), file = path("ticks.jsonl");
  std::string of_plate, of_box;
  for (int triangle = 0; triangle < 12; ++triangle) {
    of_plate += fmt::format("{}\n", triangle + 1);
    of_box += "30\n";
  }
  const std::vector<std::string> labels{"--labels-fixed", write("plate.txt", of_plate),
                                        "--labels-held",  write("box.txt", of_box),
                                        "--numbering",    "universal"};
  std::vector<std::string> more{"--unpaced", "--record", file, "--json"};
  more.insert(more.end(), labels.begin(), labels.end());
  const nlohmann::json report = json_lines(ist_well(run(scene, more)).out).back();
  using Place = std::pair<int, int>;  // body and tooth
  struct Sum {
    int ticks = 0;
    double sum = 0, largest = 0;
  };
  std::map<Place, Sum> expected;
  for (const auto& tick : json_lines(file_content(file))) {
    std::map<Place, Eigen::Vector3d> forces;
    for (const auto& point : tick["points"]) {
      const auto [x, y, z] = point["force"].get<std::array<double, 3>>();
      const Eigen::Vector3d force(x, y, z);
      for (const Place& place : {Place{0, point["triangles"][0].get<int>() + 1}, Place{1, 30}}) {
        forces.try_emplace(place, Eigen::Vector3d::Zero()).first->second += force;
      }
    }
    for (const auto& [place, force] : forces) {
      Sum& sum = expected[place];
      ++sum.ticks;
      sum.sum += force.norm();
      sum.largest = std::max(sum.largest, force.norm());
    }
  }
  EXPECT_GE(expected.size(), 3u) << "two triangles of the plate";
  ASSERT_EQ(report["teeth"].size(), 13u);
  for (const auto& tooth : report["teeth"]) {
    const bool is_held = tooth["tooth"] == 30;
    EXPECT_EQ(tooth["body"], is_held ? "held" : "fixed");
    const Sum sum = expected[{is_held ? 1 : 0, tooth["tooth"].get<int>()}];
    EXPECT_EQ(tooth["ticks"], sum.ticks);
    EXPECT_NEAR(tooth["largest_force"], sum.largest, 1e-12);
    EXPECT_NEAR(tooth["mean_force"], sum.ticks > 0 ? sum.sum / sum.ticks : 0, 1e-12);
  }

  more = {"--unpaced"};
  more.insert(more.end(), labels.begin(), labels.end());
  const std::string said = ist_well(run(scene, more)).out;
  EXPECT_TRUE(says(said, "forces on teeth, N"));
  const Sum of_30 = expected[{1, 30}];
  EXPECT_TRUE(says(said, fmt::format("{:>10}{:>10.3g}{:>10.3g}\n", of_30.ticks,
                                     of_30.sum / of_30.ticks, of_30.largest)));
}

TEST_F(RunRecord, LabelsThatDoNotFitAreRefused) {
  const std::string scene = write("rest.toml", kRest);
  const std::string labels = write("eleven.txt", "1\n2\n3\n4\n5\n6\n7\n8\n9\n10\n11\n");
  const auto refused = [&](const std::string& of, const std::vector<std::string>& more,
                           const std::string& why, int code) {
    const CommandResult result = ist(run(of, more));
    EXPECT_EQ(result.exit_code, code) << result.err;
    EXPECT_TRUE(says(result.err, why));
  };
  refused(scene, {"--labels-held", labels}, "--numbering", 2);
  refused(scene, {"--numbering", "fdi"}, "--labels-fixed", 2);
  refused(scene, {"--labels-held", labels, "--numbering", "fdi", "--replay", "a.jsonl"}, "--replay",
          2);
  refused(shipped("press"), {"--labels-held", labels, "--numbering", "fdi"}, "contact", 2);
  refused(scene, {"--labels-held", labels, "--numbering", "universal", "--check"},
          "11 labels for a mesh of 12 triangles", 3);
  refused(scene, {"--labels-held", labels, "--numbering", "fdi", "--check"}, "FDI", 3);
}

TEST_F(RunRecord, DamagedRecordingsAreRefusedWithFileLineAndRemedy) {
  const std::string scene = boxes(), file = path("ticks.jsonl");
  ist_well(run(scene, {"--unpaced", "--seconds", "0.05", "--record", file}));
  const std::vector<std::string> lines = lines_of(file_content(file));
  ASSERT_EQ(lines.size(), 51u);
  const std::string& third = lines[3];  // below the header
  const auto with_third = [&](const std::string& line) {
    return lines[0] + '\n' + lines[1] + '\n' + lines[2] + '\n' + line + '\n';
  };
  const std::size_t device = third.find("\"device\":["), end = third.find(']', device);
  const std::vector<std::pair<std::string, std::string>> damaged{
      {third.substr(0, 100), "not a JSON object"},
      {"", "not a JSON object"},
      {"[1, 2]", "not a JSON object"},
      {replaced(third, "\"tick\"", "\"tock\""), "no key 'tick'"},
      {replaced(third, "\"tick\":2", "\"tick\":null"), "'tick' is not a whole number"},
      {replaced(third, "\"tick\":2", "\"tick\":-2"), "'tick' is not a whole number"},
      {replaced(third, "\"complete\"", "\"whole\""), "no key 'complete'"},
      {replaced(third, "\"complete\":true", "\"complete\":1"),
       "'complete' is neither true, false nor null"},
      {replaced(third, "\"held\"", "\"stuck\""), "no key 'held'"},
      {replaced(third, "\"held\":false", "\"held\":null"), "'held' is neither true nor false"},
      {replaced(third, "\"steps\"", "\"feet\""), "no key 'steps'"},
      {replaced(third, "\"steps\":", "\"steps\":-"), "'steps' is not a whole number"},
      {replaced(third, "\"steps\":", "\"steps\":99999999999"), "'steps' is not a whole number"},
      {replaced(third, "\"device\":[", "\"device\":[1,"), "'device' is not an array of 12 numbers"},
      {replaced(third, "\"device\":[", "\"device\":[\"x\","),
       "'device' is not an array of 12 numbers"},
      {third.substr(0, device) + "\"device\":[0,0,0,2,0,0,0,2,0,0,0,2" + third.substr(end),
       "'device' is not a rigid motion"},
      {replaced(third, "\"device\"", "\"hand\""), "no key 'device'"}};
  for (const auto& [line, flaw] : damaged) {
    const std::string bad = write("bad.jsonl", with_third(line)), out = path("out.jsonl");
    const CommandResult result = ist(run(scene, {"--replay", bad, "--record", out}));
    EXPECT_EQ(result.exit_code, 3) << line;
    EXPECT_EQ(result.err, "ist: " + bad + ":4: " + flaw +
                              ": give a file that --record wrote as JSON lines [input-invalid]\n");
    EXPECT_FALSE(exists("out.jsonl"));
  }
  const CommandResult missing = ist(run(scene, {"--replay", path("none.jsonl")}));
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_TRUE(says(missing.err, "none.jsonl: "));
  const CommandResult folder = ist(run(scene, {"--replay", std::string(dir_.path())}));
  EXPECT_EQ(folder.exit_code, 3) << "a folder is no recording";
}

// The first line says of what it is a recording; another scene does not replay it.
TEST_F(RunRecord, ReplayRefusesARecordingOfAnotherScene) {
  const std::string body = ball(), file = path("ticks.jsonl");
  const std::string text = replaced(file_content(shipped("press")),
                                    "shape = \"sphere\"\nradius = 5", "file = \"ball.stl\"");
  const std::string scene = write("own.toml", text);
  ist_well(run(scene, {"--unpaced", "--seconds", "0.01", "--record", file}));
  const std::string recorded = file_content(file), first = lines_of(recorded)[0];
  const nlohmann::json header = nlohmann::json::parse(first);
  EXPECT_EQ(header["recording"], 3);
  EXPECT_EQ(header["scene"], text);
  EXPECT_EQ(header["dt"], 0.001);
  EXPECT_EQ(header["unit"], 0.001);
  ASSERT_EQ(header["bodies"].size(), 2u);
  EXPECT_EQ(header["bodies"][0]["name"], "fixed");
  EXPECT_EQ(header["bodies"][0]["held"], false);
  EXPECT_TRUE(header["bodies"][0]["hash"].is_null());
  EXPECT_EQ(header["bodies"][1]["file"], "ball.stl");
  EXPECT_EQ(header["bodies"][1]["held"], true);
  EXPECT_EQ(header["bodies"][1]["hash"].get<std::string>().size(), 16u);

  const auto expect_refused = [&](const std::string& by, const std::string& replayed,
                                  const std::string& what) {
    const CommandResult result = ist(run(by, {"--replay", replayed}));
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_TRUE(says(result.err, replayed + ":1: " + what)) << result.err;
  };
  const auto with_header = [&](const std::string& header_line) {
    return write("other.jsonl", header_line + recorded.substr(first.size()));
  };
  expect_refused(write("other.toml", text + "# changed\n"), file,
                 "it was recorded with another scene, which differs from line");
  expect_refused(scene, write("old.jsonl", recorded.substr(first.size() + 1)),
                 "no header of a recording");
  for (const char* other : {"2", "4"}) {
    expect_refused(
        scene,
        with_header(replaced(first, "\"recording\":3", std::string("\"recording\":") + other)),
        std::string("a recording of format ") + other +
            ", and this version reads 3: record the scene again, or use");
  }
  expect_refused(scene, with_header("{\"recording\":3}"), "no text 'scene'");
  expect_refused(scene, with_header(replaced(first, "\"bodies\"", "\"corpora\"")),
                 "no array 'bodies'");
  write("ball.stl", file_content(body) + " ");
  expect_refused(scene, file, "the file of 'held', \"ball.stl\", is not the one");
}

// A body that the hand takes has a line of its own, before its tick's; a replay writes the same.
TEST_F(RunRecord, ChangesOfTheHandHaveLinesOfTheirOwn) {
  const std::string scene = write("two.toml", R"(unit = "mm"
seconds = 0.05
[[fixed]]
name = "plate"
shape = "box"
size = [20, 20, 4]
voxel_size = 1
[[fixed]]
name = "piece"
shape = "box"
size = [4, 4, 4]
voxel_size = 1
translation = [0, 0, 6]
attachable = true
[held]
name = "tool"
shape = "box"
size = [4, 4, 4]
voxel_size = 1
translation = [8, 0, 6]
[device]
kind = "hand"
plan = [{ time = 0, move = [0, 0, 0] }, { time = 0.05, move = [0, 0, 1] }]
[[changes]]
time = 0.01
attach = "piece"
[[changes]]
time = 0.03
release = "piece"
[effects.springs]
)");
  const std::string first = path("first.jsonl"), again = path("again.jsonl");
  const CommandResult result = ist_well(run(scene, {"--unpaced", "--record", first, "--json"}));
  const auto report = json_lines(result.out).back();
  ASSERT_EQ(report["changes"].size(), 2u);
  EXPECT_EQ(report["changes"][0],
            (nlohmann::json{{"time", 0.01}, {"attach", "piece"}, {"status", "done"}}));
  const std::vector<std::string> lines = lines_of(file_content(first));
  ASSERT_EQ(lines.size(), 53u);
  EXPECT_EQ(lines[11], R"({"tick":10,"attach":"piece","status":"done"})");
  EXPECT_EQ(lines[32], R"({"tick":30,"release":"piece","status":"done"})");
  ist_well(run(scene, {"--replay", first, "--record", again}));
  EXPECT_TRUE(without_times(file_content(again)) == without_times(file_content(first)));

  // Where a deadline ended the query of a change, its replay ends too.
  const std::string late = write("late.jsonl", replaced(file_content(first), lines[11],
                                                        replaced(lines[11], "done", "unfinished")));
  ist_well(run(scene, {"--replay", late, "--record", again}));
  EXPECT_EQ(lines_of(file_content(again))[11],
            R"({"tick":10,"attach":"piece","status":"unfinished"})");
  const std::string none =
      write("none.jsonl", replaced(file_content(first), ",\"status\":\"done\"}", "}"));
  const CommandResult refused = ist(run(scene, {"--replay", none}));
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_TRUE(says(refused.err, "none.jsonl:12: a change without a text 'status'")) << refused.err;
}

TEST_F(RunRecord, ReplayRefusesAnotherScript) {
  const std::string begin = "time,x,y,z,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n0.05,0,0,";
  write("rail.csv", begin + "0.5,1,0,0,0\n");
  const std::string scene = write("rail.toml", replaced(file_content(shipped("press")), "[fixed]\n",
                                                        "[fixed]\nscript = \"rail.csv\"\n"));
  const std::string file = path("ticks.jsonl");
  ist_well(run(scene, {"--unpaced", "--seconds", "0.01", "--record", file}));
  const auto header = nlohmann::json::parse(lines_of(file_content(file))[0]);
  EXPECT_EQ(header["bodies"][0]["script"], "rail.csv");
  EXPECT_TRUE(header["bodies"][1]["script"].is_null());
  ist_well(run(scene, {"--replay", file}));
  write("rail.csv", begin + "0.4,1,0,0,0\n");
  const CommandResult result = ist(run(scene, {"--replay", file}));
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_TRUE(says(result.err, ":1: the script of 'fixed', \"rail.csv\", is not the one"))
      << result.err;
}

TEST_F(RunRecord, AFullDiskEndsTheRun) {
  for (const auto& pace :
       std::vector<std::vector<std::string>>{{"--unpaced"}, {"--allow-missed", "100000"}}) {
    std::vector<std::string> arguments =
        run(boxes(), {"--record", "/dev/full", "--seconds", "0.5"});
    arguments.insert(arguments.end(), pace.begin(), pace.end());
    const CommandResult result = ist(arguments);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_TRUE(says(result.err, "/dev/full: cannot write the file: No space left on device"));
  }
}

TEST_F(RunRecord, DoesNotWriteOverWhatItReads) {
  const std::string body = ball(), before = file_content(body);
  const std::string scene =
      write("own.toml", replaced(file_content(shipped("press")), "shape = \"sphere\"\nradius = 5",
                                 "file = \"ball.stl\""));
  for (const std::string& file : {scene, body}) {
    const std::string content = file_content(file);
    EXPECT_EQ(ist(run(scene, {"--unpaced", "--seconds", "0.01", "--record", file})).exit_code, 2)
        << file;
    EXPECT_EQ(file_content(file), content);
  }
  const std::string ticks = path("ticks.jsonl");
  ist_well(run(scene, {"--unpaced", "--seconds", "0.01", "--record", ticks}));
  EXPECT_EQ(ist(run(scene, {"--replay", ticks, "--record", ticks})).exit_code, 2);
}

}  // namespace
}  // namespace ist::test
