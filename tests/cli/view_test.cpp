#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cli/cli_case.h"
#include "cli/page/page_file.h"
#include "ist/mesh/format/base64.h"
#include "ist/tree/sphere_tree.h"
#include "support/errors.h"
#include "support/scoped_variable.h"
#include "support/shapes.h"
#include "support/temp_dir.h"

namespace ist::test {
namespace {

using nlohmann::json;

// ist view, and what other commands write into the page: into a page of a few bytes.
class View : public CliTest {
 protected:
  View() { name_page(page_); }
  void name_page(const std::string& file) const { variable_.set(file.c_str()); }

  static constexpr const char* kBegin = R"(<script type="application/json" id="ist-data">)";
  static constexpr const char* kEnd = "</script>";

  // The data in a page, whose other bytes must be those of the empty one.
  [[nodiscard]] json data_of(const std::string& file) const {
    const std::string html = file_content(path(file)), before = html_.substr(0, html_.find("null"));
    const std::size_t begin = before.size(), end = html.find(kEnd, begin);
    EXPECT_EQ(html.substr(0, begin), before);
    EXPECT_EQ(html.substr(end), html_.substr(begin + 4));
    return json::parse(html.substr(begin, end - begin));
  }
  static SphereTree tree_of(const json& body) {
    const std::string text = body["tree"];
    const auto padding = static_cast<std::size_t>(std::count(text.begin(), text.end(), '='));
    const std::string bytes = *decode_base64(text, text.size() / 4 * 3 - padding);
    return tree_from_bytes(std::as_bytes(std::span(bytes)), "page");
  }
  void refuses(const std::vector<std::string>& arguments, int code, const std::string& part) const {
    const std::size_t before = dir_.entries();
    const CommandResult result = ist(arguments);
    EXPECT_EQ(result.exit_code, code) << result.err;
    EXPECT_TRUE(says(result.err, part));
    EXPECT_EQ(dir_.entries(), before);
  }
  // A ball that is pressed on a box for 20 ms: the scene, and its recording.
  [[nodiscard]] std::string scene() const {
    return write("scene.toml", R"(unit = "mm"
seconds = 0.02  # </script>
[fixed]
shape = "box"
size = [4, 4, 4]
voxel_size = 0.5
[held]
shape = "sphere"
radius = 1
voxel_size = 0.5
translation = [0, 0, 4]
[device]
kind = "hand"
plan = [{ time = 0, move = [0, 0, 0] }]
[effects.springs]
)");
  }

  const std::string html_ = std::string("<html>") + kBegin + "null" + kEnd + "<p>rest</p></html>";
  const std::string page_ = write("page.html", html_);
  const ScopedVariable variable_{"IST_PAGE", nullptr};
};

TEST_F(View, HoldsTwoBodiesWithTheirTriangles) {
  const std::string one = ball(), other = needle("needle.stl", 5);
  ist_well({"view", one, other, "--move", "0,0,1.5", "-o", path("out.html")});
  const json data = data_of("out.html");
  EXPECT_EQ(data["format"], 1);
  EXPECT_EQ(data["kind"], "bodies");
  EXPECT_TRUE(says(data["made_by"].get<std::string>(), "ist 0."));
  ASSERT_EQ(data["bodies"].size(), 2U);
  EXPECT_EQ(data["bodies"][0]["role"], "fixed");
  EXPECT_EQ(data["bodies"][1]["name"], "needle.stl");
  EXPECT_EQ(data["pose"][14], 1.5);
  const TriangleMesh wanted = read_mesh(one);
  const SphereTree tree = tree_of(data["bodies"][0]);
  ASSERT_NE(tree.triangles(), nullptr);
  EXPECT_EQ(tree.triangles()->triangles, wanted.triangles);
  EXPECT_EQ(tree.triangles()->vertices, wanted.vertices);
  ist_well({"view", ball_tree(), "-o", path("one.html")});
  EXPECT_EQ(data_of("one.html")["bodies"].size(), 1U);
  ist_well({"view", one, other, "--no-names", "-o", path("out.html")});
  const json nameless = data_of("out.html");
  EXPECT_EQ(nameless["bodies"][0]["name"], "fixed");
  EXPECT_EQ(nameless["bodies"][1]["name"], "moving");
  EXPECT_EQ(tree_of(nameless["bodies"][1]).source().name, "");
}

TEST_F(View, WarnsOnceOfABodyAlone) {
  const std::string one = mesh("open.stl", open_strip(2)),
                    warning = "is an open surface, as scans usually are";
  const std::string err = ist_well({"view", one, "-o", path("one.html")}).err;
  ASSERT_TRUE(says(err, warning)) << err;
  EXPECT_EQ(err.find(warning), err.rfind(warning)) << err;
}

TEST_F(View, NoNameEndsTheElementThatHoldsIt) {
  const std::string name = "<script> <!--";  // a file's name has no slash
  const std::string odd = mesh(name + ".stl", icosphere(2, 2));
  ist_well({"view", odd, odd, "-o", path("out.html")});
  EXPECT_EQ(data_of("out.html")["bodies"][0]["name"], name + ".stl");
  ist_well({"occlusion", odd, odd, "-o", path("bite.html")});
  EXPECT_EQ(data_of("bite.html")["bodies"][0]["name"], name + ".stl");
  const std::string scene = this->scene();
  ist_well({"run", scene, "--unpaced", "--record", path("t.jsonl")});
  ist_well({"view", path("t.jsonl"), "-o", path("run.html")});
  EXPECT_TRUE(says(data_of("run.html")["recording"].get<std::string>(), "</script>"));
}

TEST_F(View, ABiteIsAPageIfThereIsOneElseTheStaticReport) {
  const std::string one = mesh("ball.stl", icosphere(4, 2)),
                    plate = mesh("plate.stl", box({-5, -5, -3}, {5, 5, 0}));
  const std::vector<std::string> asked{"occlusion", plate,    one,  "--move",          "0,0,1.8",
                                       "--preset",  "owens",  "-o", path("bite.html"), "--frame",
                                       "lps",       "--unit", "mm"};
  ist_well(asked);
  const json data = data_of("bite.html");
  EXPECT_EQ(data["kind"], "bite");
  EXPECT_EQ(data["bodies"][0]["name"], "plate.stl");
  EXPECT_EQ(data["occlusion"],
            json({{"preset", "owens"}, {"reach", 2.0}, {"frame", "lps"}, {"unit", "mm"}}));
  EXPECT_EQ(data["pose"][14], 1.8);
  auto nameless = asked;
  nameless.emplace_back("--no-names");
  ist_well(nameless);
  const json without = data_of("bite.html");
  EXPECT_EQ(without["bodies"][0]["name"], "fixed");
  EXPECT_EQ(tree_of(without["bodies"][0]).source().name, "");
  // What the page does not know, the static report does.
  auto sided = asked;
  sided.resize(9);
  sided.insert(sided.end(), {"--left", "1,0,0"});
  const CommandResult plain = ist_well(sided);
  EXPECT_TRUE(says(plain.err, "the static report"));
  EXPECT_NE(file_content(path("bite.html")).find("<table id=\"shares\""), std::string::npos);
  // A name that asks for the report gets it, whatever the page knows.
  auto report = asked;
  report[8] = path("bite.report.html");
  EXPECT_FALSE(says(ist_well(report).err, "static report"));
  EXPECT_TRUE(says(file_content(path("bite.report.html")), "<table id=\"contacts\""));
  name_page("");
  EXPECT_TRUE(says(ist_well(asked).err, "this build has no page"));
  EXPECT_NE(file_content(path("bite.html")).find("<h2>Contacts</h2>"), std::string::npos);
}

TEST_F(View, ARecordingHasTheBodiesOfItsScene) {
  const std::string scene = this->scene();
  ist_well({"run", scene, "--unpaced", "--record", path("t.jsonl")});
  ist_well({"view", path("t.jsonl"), "--scene", scene, "-o", path("run.html")});
  const json data = data_of("run.html");
  EXPECT_EQ(data["kind"], "recording");
  EXPECT_EQ(data["metres_per_unit"], 1e-3);
  EXPECT_EQ(data["recording"], file_content(path("t.jsonl")));
  ASSERT_EQ(data["bodies"].size(), 2U);
  const json& held = data["bodies"][1];
  EXPECT_EQ(held["held"], true);
  EXPECT_EQ(held["index"], 1);
  // The tool's pose before the first tick moves the mesh to its place.
  EXPECT_NEAR(held["pose"][14].get<double>(), 4e-3, 1e-12);
  EXPECT_EQ(data["bodies"][0]["pose"][14], 0.0);
  const json first = json::parse(json_lines(data["recording"].get<std::string>()).front().dump());
  const double tool = first["tool"][2].get<double>(), in_tool = held["in_tool"][14].get<double>();
  EXPECT_NEAR(tool + in_tool, 4e-3, 1e-4);
  ist_well({"view", path("t.jsonl"), "-o", path("bare.html")});
  EXPECT_EQ(data_of("bare.html")["bodies"].size(), 0U);
  EXPECT_TRUE(says(data_of("bare.html")["missing"][0].get<std::string>(), "--scene"));
}

TEST_F(View, APageHoldsWhatABrowserReads) {
  const nlohmann::ordered_json block{{"name", "a<b<"}};
  const std::size_t bytes = block.dump().size();
  {
    OutputFile file(path("out.html"));
    cli::write_page(page_, block, file, bytes);
    file.commit();
  }
  EXPECT_EQ(data_of("out.html"), json(block));
  OutputFile file(path("full.html"));
  const std::optional<Error> error =
      error_of([&] { cli::write_page(page_, block, file, bytes - 1); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code(), ErrorCode::kInputInvalid);
  EXPECT_TRUE(says(error->what(), "coarser meshes"));
}

TEST_F(View, RefusesWithFileAndRemedy) {
  const std::string one = ball(), scene = this->scene();
  ist_well({"run", scene, "--unpaced", "--record", path("t.jsonl")});
  const std::string bare = ball_tree("bare.ist", "tight", {"--no-triangles"});
  const std::string out = path("out.html");
  refuses({"view", one, "-o", path("out.txt")}, 2, ".html");
  refuses({"view", one, "-o", page_}, 2, "would destroy an input");
  refuses({"view", path("none.stl"), "-o", out}, 3, "none.stl");
  refuses({"view", bare, one, "-o", out}, 2, "no triangles");
  refuses({"view", one, "--scene", scene, "-o", out}, 2, "goes with a recording");
  refuses({"view", one, "--move", "0,0,1", "-o", out}, 2, "name two files");
  refuses({"view", path("t.jsonl"), one, "-o", out}, 2, "all bodies of its scene");
  refuses({"view", path("t.jsonl"), "--move", "0,0,1", "-o", out}, 2, "its own poses");
  refuses({"view", path("t.jsonl"), "--no-names", "-o", out}, 2, "names its files");
  write("scene.toml", file_content(scene) + "# another\n");
  refuses({"view", path("t.jsonl"), "--scene", scene, "-o", out}, 3, "another scene");
  const std::string old = write("old.jsonl", R"({"recording":2,"scene":""})");
  refuses({"view", old, "-o", out}, 3, "a recording of format 2, and this version reads 3: record");
  write("page.html", "<html>no page</html>");
  refuses({"view", one, "-o", out}, 3, "scripts/viewer.sh");
  write("page.html", html_ + html_);
  refuses({"view", one, "-o", out}, 3, "page.html");
  write("page.html", html_);
  const std::string long_one = write("long.jsonl", R"({"recording":3,)");
  std::filesystem::resize_file(long_one, 300'000'001);  // it takes no place on the disk
  refuses({"view", long_one, "-o", out}, 3, "long.jsonl: it has 300 MB, and a page holds");
  name_page(path("gone.html"));
  refuses({"view", one, "-o", out}, 3, "gone.html");
  name_page("");
  refuses({"view", one, "-o", out}, 1, "this build has no page");
}

}  // namespace
}  // namespace ist::test
