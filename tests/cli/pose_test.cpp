#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "cli/cli_case.h"
#include "support/shapes.h"

namespace ist::test {
namespace {

using nlohmann::json;

// Where people say that the moving body is.
class Pose : public CliTest {
 protected:
  [[nodiscard]] Eigen::Matrix4d asked(std::vector<std::string> named) const {
    std::vector<std::string> arguments{"collide", tree_, tree_, "--json"};
    arguments.insert(arguments.end(), named.begin(), named.end());
    const auto lines = json_lines(ist_well(arguments).out);
    Eigen::Matrix4d pose = Eigen::Matrix4d::Zero();
    if (lines.size() != 1) return pose;
    for (Eigen::Index i = 0; i < 16; ++i) {
      pose.data()[i] = lines[0]["pose"][static_cast<std::size_t>(i)].get<double>();
    }
    return pose;
  }
  void refuses(const std::vector<std::string>& named, int code, const std::string& part) const {
    std::vector<std::string> arguments{"collide", tree_, tree_};
    arguments.insert(arguments.end(), named.begin(), named.end());
    const CommandResult result = ist(arguments);
    EXPECT_EQ(result.exit_code, code) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_TRUE(says(result.err, part));
  }
  [[nodiscard]] std::string itk(const std::string& type, const std::string& parameters,
                                const std::string& fixed) const {
    return write("given.tfm", "#Insight Transform File V1.0\n#Transform 0\nTransform: " + type +
                                  "\nParameters: " + parameters + "\nFixedParameters: " + fixed +
                                  "\n");
  }

  const std::string tree_ = ball_tree();
};

TEST_F(Pose, IsAsStoredWhereNoneIsNamed) { EXPECT_EQ(asked({}), Eigen::Matrix4d::Identity()); }

TEST_F(Pose, TurnsFirstAndMovesAfter) {
  Eigen::Matrix4d expected;
  expected << 0, -1, 0, 1, 1, 0, 0, 2, 0, 0, 1, -3, 0, 0, 0, 1;
  EXPECT_EQ(asked({"--move", "1,2,-3", "--turn", "z,90"}), expected);
  EXPECT_EQ(asked({"--turn", "0,0,2,-270", "--move", "1,2,-3"}), expected);
  EXPECT_EQ(asked({"--turn", "-z,270", "--move", " 1 2 -3"}), expected);
  // About a point, which stays where it is.
  const Eigen::Matrix4d about = asked({"--turn", "x,30@5,6,7"});
  EXPECT_LE((about * Eigen::Vector4d(5, 6, 7, 1) - Eigen::Vector4d(5, 6, 7, 1)).norm(), 1e-14);
  EXPECT_NEAR(about(1, 1), std::cos(std::numbers::pi / 6), 1e-15);
  EXPECT_NEAR(about(2, 1), 0.5, 1e-15);
  const CommandResult echoed = ist_well({"collide", tree_, tree_, "--turn", "z,90"});
  EXPECT_TRUE(says(echoed.err, "pose, moving to fixed coordinates"));
  EXPECT_TRUE(says(echoed.err, "0            -1             0             0\n"));
}

TEST_F(Pose, IsReadRowByRow) {
  Eigen::Matrix4d expected;
  expected << 0, -1, 0, 1.5, 1, 0, 0, 2, 0, 0, 1, -3, 0, 0, 0, 1;
  EXPECT_EQ(asked({"--matrix", write("m.txt", "0 -1 0 1.5\n1 0 0 2\n0 0 1 -3\n0 0 0 1\n")}),
            expected);
  EXPECT_EQ(asked({"--matrix", write("m.csv", "0,-1,0,1.5\r\n1,0,0,2\r\n0,0,1,-3\r\n0,0,0,1\r\n")}),
            expected);
}

// ITK's formula by hand: y = R (x - c) + t + c maps fixed to moving points, so the pose is its
// inverse. A quarter turn about z round c = (10, 20, 30), then t = (1, 2, 3), takes (10, 20, 30) to
// (11, 22, 33) and (11, 20, 30) to (11, 23, 33).
TEST_F(Pose, OfItkIsInverted) {
  const std::string h = "0.70710678118654757", quarter = "1.5707963267948966";
  const std::pair<std::string, std::string> same[] = {
      {"AffineTransform_double_3_3", "0 -1 0 1 0 0 0 0 1 1 2 3"},
      {"MatrixOffsetTransformBase_double_3_3", "0 -1 0 1 0 0 0 0 1 1 2 3"},
      {"Rigid3DTransform_float_3_3", "0 -1 0 1 0 0 0 0 1 1 2 3"},
      {"VersorRigid3DTransform_double_3_3", "0 0 " + h + " 1 2 3"},
      {"Euler3DTransform_double_3_3", "0 0 " + quarter + " 1 2 3"}};
  for (const auto& [type, parameters] : same) {
    const Eigen::Matrix4d pose = asked({"--matrix", itk(type, parameters, "10 20 30")});
    const auto goes = [&, &type = type](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
      EXPECT_LE((pose * from.homogeneous() - to.homogeneous()).norm(), 1e-12) << type;
    };
    goes({11, 22, 33}, {10, 20, 30});
    goes({11, 23, 33}, {11, 20, 30});
  }
  const Eigen::Matrix4d moved =
      asked({"--matrix", itk("TranslationTransform_double_3_3", "1 2 3", "")});
  EXPECT_EQ(Eigen::Vector3d(moved.topRightCorner<3, 1>()), Eigen::Vector3d(-1, -2, -3));
}

// R = Rz Rx Ry, or Rz Ry Rx where a fourth fixed parameter says so.
TEST_F(Pose, OfItkTurnsInItsOrder) {
  const auto turn = [](int axis, double angle) {
    return Eigen::Matrix3d(Eigen::AngleAxisd(angle, Eigen::Vector3d::Unit(axis)));
  };
  for (const bool zyx : {false, true}) {
    const Eigen::Matrix4d pose =
        asked({"--matrix", itk("Euler3DTransform_double_3_3", "0.1 0.2 0.3 0 0 0",
                               zyx ? "0 0 0 1" : "0 0 0 0")});
    const Eigen::Matrix3d expected =
        zyx ? Eigen::Matrix3d(turn(2, 0.3) * turn(1, 0.2) * turn(0, 0.1))
            : Eigen::Matrix3d(turn(2, 0.3) * turn(0, 0.1) * turn(1, 0.2));
    EXPECT_LE((pose.topLeftCorner<3, 3>() - expected.transpose()).norm(), 1e-12) << zyx;
  }
}

TEST_F(Pose, AnAxisHasAnyLengthButZero) {
  const Eigen::Matrix4d expected = asked({"--turn", "1,2,2,30"});
  for (const char* turn : {"1e-300,2e-300,2e-300,30", "1e300,2e300,2e300,30"}) {
    EXPECT_LE((asked({"--turn", turn}) - expected).cwiseAbs().maxCoeff(), 1e-15) << turn;
  }
}

TEST_F(Pose, SaysHowFarItWasFromARotation) {
  const auto error = [&](const std::string& option, const std::string& file) {
    const auto lines = json_lines(ist_well({"collide", tree_, tree_, "--json", option, file}).out);
    return lines.at(0)["rotation_error"].get<double>();
  };
  EXPECT_EQ(error("--move", "1,2,3"), 0);
  EXPECT_EQ(error("--matrix", write("m.txt", "1 4e-4 0 5 0 1 0 0 0 0 1 0 0 0 0 1")), 4e-4);
  EXPECT_EQ(error("--poses", write("p.json",
                                   "[{\"pose\": [1,0,0,0, 3e-4,1,0,0, 0,0,1,0, "
                                   "0,0,5,1]}]")),
            3e-4);
  EXPECT_EQ(
      error("--matrix", itk("AffineTransform_double_3_3", "1 2e-4 0 0 1 0 0 0 1 0 0 0", "0 0 0")),
      2e-4);
}

TEST_F(Pose, BadOnesAreRefused) {
  for (const char* move : {"1,2", "1,2,x", "1,2,3,4", "nan,0,0", "", "inf,0,0"}) {
    if (*move != '\0') refuses({"--move", move}, 2, "give x,y,z in mesh units");
  }
  refuses({"--turn", "z"}, 2, "give axis,degrees");
  refuses({"--turn", "w,90"}, 2, "w is no axis");
  refuses({"--turn", "z,ninety"}, 2, "give axis,degrees");
  refuses({"--turn", "z,90@1,2"}, 2, "give axis,degrees");
  refuses({"--turn", "0,0,0,90"}, 2, "no length");
  refuses({"--move", "0,0,1", "--matrix", write("m.txt", "")}, 2, "--m");
  refuses({"--move", "0,0,1", "--poses", poses({0})}, 2, "--poses");
  refuses({"--matrix", path("none.txt")}, 3, "none.txt");
  refuses({"--matrix", write("m.txt", "1 2 3")}, 3, "m.txt: give 4 lines of 4 finite numbers");
  refuses({"--matrix", write("m.txt", "1 0 0 0 0 1 0 0 0 0 2 0 0 0 0 1")}, 3, "not a rigid motion");
  refuses({"--matrix", write("m.txt", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 nan")}, 3, "finite");
  refuses({"--matrix", write("m.txt", "1.0001 0 0 0 0 1.0001 0 0 0 0 1.0001 0 0 0 0 1")}, 3,
          "not a rigid motion: its scale");
}

TEST_F(Pose, OtherTransformsOfItkAreRefused) {
  const auto with = [&](const std::string& type, const std::string& parameters,
                        const std::string& fixed, const std::string& part) {
    refuses({"--matrix", itk(type, parameters, fixed)}, 3, part);
  };
  with("AffineTransform_double_3_3", "2 0 0 0 1 0 0 0 1 0 0 0", "0 0 0", "not a rigid motion");
  with("AffineTransform_double_3_3", "1 0 0 0 1 0 0 0 1 0 0", "0 0 0", "of 11 parameters");
  with("AffineTransform_double_2_2", "1 0 0 1 0 0", "0 0", "AffineTransform");
  with("Similarity3DTransform_double_3_3", "0 0 0 0 0 0 1", "0 0 0", "Similarity3DTransform");
  with("BSplineTransform_double_3_3", "0 0 0", "0 0 0", "are read");
  with("VersorRigid3DTransform_double_3_3", "0 0 x 0 0 0", "0 0 0", "finite numbers");
  refuses({"--matrix", write("two.tfm",
                             "#Insight Transform File V1.0\n#Transform 0\nTransform: "
                             "TranslationTransform_double_3_3\nParameters: 1 2 3\n#Transform "
                             "1\nTransform: TranslationTransform_double_3_3\nParameters: 1 2 3\n")},
          3, "several transforms");
  refuses({"--matrix", write("none.tfm", "#Insight Transform File V1.0\n")}, 3, "Transform:");
}

}  // namespace
}  // namespace ist::test
