#include "loop/haptics/devices/script_device.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "support/errors.h"
#include "support/temp_dir.h"

namespace ist::test {
namespace {

const std::string kHeader = "time,x,y,z,qw,qx,qy,qz\n";

std::vector<Waypoint> read(const std::string& bytes, double metres = 1e-3) {
  const TempDir folder;
  return read_script(folder.write("script.csv", bytes), metres);
}

TEST(ReadScript, TakesTimesLengthsAndTurns) {
  const std::vector<Waypoint> waypoints =
      read(kHeader + "0,1,2,-3,1,0,0,0\n0.5, 1.5 ,2e1,-3,3,0,3,0\n1.25,0,0,0,1,0,0,0\n");
  ASSERT_EQ(waypoints.size(), 3U);
  EXPECT_EQ(waypoints[0].time, 0);
  EXPECT_EQ(waypoints[0].pose.translation, 1e-3 * Eigen::Vector3d(1, 2, -3));
  EXPECT_EQ(waypoints[0].pose.rotation, Eigen::Matrix3d::Identity());
  EXPECT_EQ(waypoints[1].time, 0.5);
  EXPECT_EQ(waypoints[1].pose.translation, 1e-3 * Eigen::Vector3d(1.5, 20, -3));
  Eigen::Matrix3d quarter;  // about y
  quarter << 0, 0, 1, 0, 1, 0, -1, 0, 0;
  EXPECT_LE((waypoints[1].pose.rotation - quarter).norm(), 1e-15);
  EXPECT_EQ(waypoints[2].time, 1.25);
  EXPECT_EQ(waypoints[2].pose.translation, Eigen::Vector3d::Zero());
}

TEST(ReadScript, NormalisesQuaternionsOfAnyLength) {
  const double third = std::sqrt(3.0) / 2;
  for (const char* scale : {"1", "1e-300", "1e300", "0.25"}) {
    const std::vector<Waypoint> waypoints =
        read(kHeader + "0,0,0,0,1,0,0,0\n1,0,0,0," + scale + ",0,0," + scale + "\n");
    ASSERT_EQ(waypoints.size(), 2U) << scale;
    Eigen::Matrix3d quarter;  // about z
    quarter << 0, -1, 0, 1, 0, 0, 0, 0, 1;
    EXPECT_LE((waypoints[1].pose.rotation - quarter).norm(), 1e-15) << scale;
  }
  // q and -q are one turn.
  const auto turned = read(kHeader + "0,0,0,0,-0.5,0,0,-0.8660254037844386\n");
  Eigen::Matrix3d expected;
  expected << -0.5, -third, 0, third, -0.5, 0, 0, 0, 1;
  EXPECT_LE((turned[0].pose.rotation - expected).norm(), 1e-15);
}

TEST(ReadScript, TakesEveryKindOfLineEnd) {
  for (const char* bytes : {
           "time,x,y,z,qw,qx,qy,qz\n0,1,0,0,1,0,0,0\n2,3,0,0,1,0,0,0\n",
           "time,x,y,z,qw,qx,qy,qz\n0,1,0,0,1,0,0,0\n2,3,0,0,1,0,0,0",
           "time,x,y,z,qw,qx,qy,qz\r\n0,1,0,0,1,0,0,0\r\n2,3,0,0,1,0,0,0\r\n",
           "time,x,y,z,qw,qx,qy,qz\r\n0,1,0,0,1,0,0,0\r\n2,3,0,0,1,0,0,0",
           "\n time,x,y,z,qw,qx,qy,qz\n\n0,1,0,0,1,0,0,0\n  \n2,3,0,0,1,0,0,0\n\n\n",
           "\xEF\xBB\xBFtime,x,y,z,qw,qx,qy,qz\r\n0,1,0,0,1,0,0,0\r\n2,3,0,0,1,0,0,0\r\n",
       }) {
    const std::vector<Waypoint> waypoints = read(bytes, 1);
    ASSERT_EQ(waypoints.size(), 2U) << bytes;
    EXPECT_EQ(waypoints[1].time, 2) << bytes;
    EXPECT_EQ(waypoints[1].pose.translation.x(), 3) << bytes;
  }
}

TEST(ReadScript, RefusesBadLinesNamingFileLineAndRemedy) {
  const std::string first = "0,0,0,0,1,0,0,0\n";
  const struct {
    std::string bytes;
    const char* says;  // after the file's name
  } cases[] = {
      {"", "line 1: '' is not the header: begin with the line time,x,y,z,qw,qx,qy,qz"},
      {first, "line 1: '0,0,0,0,1,0,0,0' is not the header"},
      {"time,x,y,z\n" + first, "line 1: 'time,x,y,z' is not the header"},
      {"time,x,y,z,qx,qy,qz,qw\n" + first, "line 1: 'time,x,y,z,qx,qy,qz,qw' is not the header"},
      {kHeader, "line 1: no waypoint follows the header: give at least one, at time 0"},
      {kHeader + "\n\n", "no waypoint follows the header"},
      {kHeader + "0,0,0,0,1,0,0\n", "line 2: the line has 7 columns: give the eight of time,x"},
      {kHeader + "0,0,0,0,1,0,0,0,0\n", "line 2: the line has 9 columns"},
      {kHeader + "0,0,0,0,1,0,0,0,\n", "line 2: the line has 9 columns"},
      {kHeader + first + "\n1;0;0;0;1;0;0;0\n", "line 4: '1;0;0;0;1;0;0;0' is no finite number"},
      {kHeader + "0,0,0,,1,0,0,0\n", "line 2: '' is no finite number: write it as 12.5 or 1.25e1"},
      {kHeader + "0,0,0,x,1,0,0,0\n", "line 2: 'x' is no finite number"},
      {kHeader + "0,0,0,1.5mm,1,0,0,0\n", "line 2: '1.5mm' is no finite number"},
      {kHeader + "0,0,nan,0,1,0,0,0\n", "line 2: 'nan' is no finite number"},
      {kHeader + "0,0,-inf,0,1,0,0,0\n", "line 2: '-inf' is no finite number"},
      {kHeader + "0,0,1e999,0,1,0,0,0\n", "line 2: '1e999' is no finite number"},
      {kHeader + "0,0,0,0,NaN,0,0,0\n", "line 2: 'NaN' is no finite number"},
      {kHeader + "0,0,0,0,0,-0,0,0\n", "line 2: the quaternion is 0: give qw = 1"},
      {kHeader + "0.1,0,0,0,1,0,0,0\n", "line 2: the first time is 0.1 s: let the plan start at 0"},
      {kHeader + first + first, "line 3: the time 0 s does not come after 0 s: let times ascend"},
      {kHeader + first + "2,0,0,0,1,0,0,0\r\n1,0,0,0,1,0,0,0\r\n", "line 4: the time 1 s does not"},
      {kHeader + first + "-1,0,0,0,1,0,0,0\n", "line 3: the time -1 s does not come after 0 s"},
      {kHeader + first + "1,0,0,0,0,1,0,0\n",
       "line 3: the turn from the waypoint before is more than a third of a circle"},
  };
  for (const auto& c : cases) {
    const TempDir folder;
    const std::filesystem::path file = folder.write("script.csv", c.bytes);
    const auto error = error_of([&] { static_cast<void>(read_script(file, 1e-3)); });
    ASSERT_TRUE(error) << c.says;
    EXPECT_EQ(error->code(), ErrorCode::kInputInvalid);
    const std::string text = error->what();
    EXPECT_TRUE(text.starts_with(file.string() + ": line ")) << text;
    EXPECT_NE(text.find(c.says), std::string::npos) << c.says << " not in " << text;
  }
}

TEST(ReadScript, RefusesALengthThatNoDoubleHoldsInMetres) {
  const auto error =
      error_of([] { static_cast<void>(read(kHeader + "0,1e308,0,0,1,0,0,0", 100)); });
  ASSERT_TRUE(error);
  EXPECT_NE(std::string(error->what()).find("line 2: the pose is no rigid motion"),
            std::string::npos);
}

TEST(ReadScript, RefusesFilesThatAreNotThereOrTooLarge) {
  const TempDir folder;
  EXPECT_EQ(error_name([&] { static_cast<void>(read_script(folder.path() / "none.csv", 1)); }),
            "file-unreadable");
  const std::filesystem::path file = folder.write("large.csv", kHeader);
  std::filesystem::resize_file(file, (std::uintmax_t{64} << 20) + 1);  // a hole: no disk is filled
  const auto error = error_of([&] { static_cast<void>(read_script(file, 1)); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code(), ErrorCode::kInputInvalid);
  EXPECT_EQ(std::string(error->what()),
            file.string() +
                ": it has 67108865 bytes, more than 67108864: give fewer waypoints; "
                "the motion between them is interpolated");
}

TEST(ScriptDevice, GoesThroughItsPlanByTheTicksItIsTold) {
  ScriptDevice device(read(kHeader + "0,0,0,0,1,0,0,0\n0.5,4,0,0,1,0,0,0\n1,4,2,0,1,0,0,0\n"),
                      {.damping = 2, .angular_damping = 0.5, .delay = 1e-3});
  EXPECT_EQ(device.mechanics().angular_damping, 0.5);
  constexpr double kDt = 0x1p-6;
  for (int tick = 0; tick <= 64; ++tick) {
    const double time = tick * kDt;
    const std::optional<Placement> seen = device.read();
    ASSERT_TRUE(seen);
    EXPECT_NEAR(seen->translation.x(), 1e-3 * std::min(4.0, 8 * time), 1e-17);
    EXPECT_NEAR(seen->translation.y(), 1e-3 * std::max(0.0, 4 * time - 2), 1e-17);
    EXPECT_FALSE(device.done()) << time;
    device.write(Vector6::Constant(1e6), kDt);  // which it does not feel
  }
  EXPECT_TRUE(device.done());
  EXPECT_EQ(device.read()->translation, 1e-3 * Eigen::Vector3d(4, 2, 0));
}

TEST(ScriptDevice, RefusesWaypointsThatAreNoPlan) {
  EXPECT_EQ(error_name([] { const ScriptDevice device({}); }), "argument-invalid");
}

}  // namespace
}  // namespace ist::test
