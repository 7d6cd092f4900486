#include "cli/contact_file.h"

#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <string>

#include "answers/formats/csv_writer.h"
#include "answers/formats/format.h"
#include "answers/formats/ply_writer.h"
#include "answers/formats/poly_data.h"
#include "answers/formats/vtp_writer.h"
#include "answers/json_parts.h"
#include "ist/base/files.h"
#include "ist/base/pose.h"
#include "ist/tree/saved_spheres.h"

namespace ist::cli {

using namespace answers;

// A leaf pair, or a contact point, as files hold it: fixed coordinates, mesh units.
struct ContactRow {
  enum class Kind : std::uint8_t { kLeafPair, kContact };

  std::size_t index = 0;  // of the pose
  Kind kind = Kind::kLeafPair;
  Eigen::Vector3d position;  // of a leaf pair, the centre of the fixed leaf's sphere
  double radius = 0;         // of that sphere; of a contact, of a disc as large as its weight
  std::optional<Eigen::Vector3d> moving_centre{};  // of a leaf pair
  std::optional<Eigen::Vector3d> normal{};         // of a contact, as the next two
  std::optional<double> depth{}, weight{};
};

class ContactFile {
 public:
  virtual ~ContactFile() = default;
  virtual void add(const ContactRow& row) = 0;
  virtual void commit() = 0;
};

namespace {

using nlohmann::ordered_json;
using Vector = Eigen::Vector3d;

constexpr std::array kContactFormats = {FileFormat::kJsonl, FileFormat::kCsv, FileFormat::kVtp,
                                        FileFormat::kPly};

const char* name_of(ContactRow::Kind kind) {
  return kind == ContactRow::Kind::kContact ? "contact" : "leaf pair";
}

class JsonlFile : public ContactFile {
 public:
  explicit JsonlFile(const std::filesystem::path& file) : file_(file) {}

  void add(const ContactRow& row) override {
    const auto triple = [](const Vector& v) { return ordered_json{v[0], v[1], v[2]}; };
    ordered_json line{{"index", row.index}, {"kind", name_of(row.kind)}};
    if (row.kind == ContactRow::Kind::kContact) {
      line["position"] = triple(row.position);
      line["normal"] = triple(*row.normal);
      line["depth"] = *row.depth;
      line["weight"] = *row.weight;
    } else {
      line["fixed_centre"] = triple(row.position);
      line["moving_centre"] = triple(*row.moving_centre);
    }
    lines_ += json_text(line);
    lines_ += '\n';
    if (lines_.size() > (1 << 20)) flush();
  }
  void commit() override {
    flush();
    file_.commit();
  }

 private:
  void flush() {
    file_.write(lines_.data(), lines_.size());
    lines_.clear();
  }

  OutputFile file_;
  std::string lines_;  // not yet written
};

class CsvFile : public ContactFile {
 public:
  explicit CsvFile(const std::filesystem::path& file)
      : table_(file, {"index", "kind", "x", "y", "z", "radius", "moving_x", "moving_y", "moving_z",
                      "normal_x", "normal_y", "normal_z", "depth", "weight"}) {}

  void add(const ContactRow& row) override {
    const auto triple = [this](const std::optional<Vector>& v) {
      for (Eigen::Index i = 0; i < 3; ++i) {
        table_.add(v ? std::optional((*v)[i]) : std::optional<double>());
      }
    };
    table_.add(row.index);
    table_.add(name_of(row.kind));
    triple(row.position);
    table_.add(row.radius);
    triple(row.moving_centre);
    triple(row.normal);
    table_.add(row.depth);
    table_.add(row.weight);
    table_.end_row();
  }
  void commit() override { table_.commit(); }

 private:
  CsvWriter table_;
};

class PointFile : public ContactFile {
 public:
  PointFile(std::filesystem::path file, FileFormat format)
      : file_(std::move(file)), format_(format) {}

  void add(const ContactRow& row) override {
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    const auto or_none = [](const std::optional<double>& number) {
      return number ? static_cast<float>(*number) : kNone;
    };
    points_.push_back(row.position);
    index_.push_back(static_cast<std::int32_t>(row.index));
    kind_.push_back(static_cast<std::uint8_t>(row.kind));
    radius_.push_back(static_cast<float>(row.radius));
    const Vector normal = row.normal.value_or(Vector(0, 0, 0));
    for (const double x : normal) normal_.push_back(static_cast<float>(x));
    depth_.push_back(or_none(row.depth));
    weight_.push_back(or_none(row.weight));
  }
  void commit() override {
    PolyData data;
    data.points = std::move(points_);
    data.point_arrays = {{"index", std::move(index_)},   {"kind", std::move(kind_)},
                         {"radius", std::move(radius_)}, {"normal", std::move(normal_), 3},
                         {"depth", std::move(depth_)},   {"weight", std::move(weight_)}};
    if (format_ == FileFormat::kVtp) return write_vtp(data, file_);
    write_ply(data, file_, "contacts: points with a radius; kind 0 a leaf pair, 1 a contact");
  }

 private:
  std::filesystem::path file_;
  FileFormat format_;
  std::vector<Vector> points_;
  std::vector<std::int32_t> index_;
  std::vector<std::uint8_t> kind_;
  std::vector<float> radius_, normal_, depth_, weight_;
};

std::unique_ptr<ContactFile> open_contact_file(const std::filesystem::path& file) {
  const FileFormat format = format_by_ending("--contacts", file, kContactFormats);
  if (format == FileFormat::kJsonl) return std::make_unique<JsonlFile>(file);
  if (format == FileFormat::kCsv) return std::make_unique<CsvFile>(file);
  return std::make_unique<PointFile>(file, format);
}

}  // namespace

std::string contact_endings() { return endings_with_programs(kContactFormats); }

void check_contact_file(const std::filesystem::path& file) {
  static_cast<void>(format_by_ending("--contacts", file, kContactFormats));
}

ContactWriter::ContactWriter(const std::filesystem::path& file, const Bodies& bodies)
    : file_(open_contact_file(file)),
      bodies_(bodies),
      fixed_(level_spheres(bodies.fixed, bodies.policy, 0)),
      moving_(level_spheres(bodies.moving, bodies.policy, 0)),
      query_(bodies.fixed, bodies.moving, {.policy = bodies.policy}),
      points_(bodies.fixed, bodies.moving, bodies.policy) {}

ContactWriter::~ContactWriter() = default;

void ContactWriter::commit() { file_->commit(); }

void ContactWriter::write(std::size_t index, const Eigen::Isometry3d& pose,
                          std::span<const LeafPair> leaf_pairs, bool complete) {
  // The rigid pose nearest to the given one, which the query answers for.
  const Eigen::Isometry3d rigid = *project_to_rigid(pose);
  for (const LeafPair& pair : leaf_pairs) {
    ContactRow row{index, ContactRow::Kind::kLeafPair,
                   bodies_.fixed.origin() + fixed_[pair.fixed].centre, fixed_[pair.fixed].radius};
    row.moving_centre = rigid * (bodies_.moving.origin() + moving_[pair.moving].centre);
    file_->add(row);
  }
  if (!complete) return;
  static_cast<void>(query_.contacts(pose, points_));
  for (const Contact& point : points_.points()) {
    ContactRow row{index, ContactRow::Kind::kContact, point.position,
                   std::sqrt(point.weight / std::numbers::pi)};
    row.normal = point.normal;
    row.depth = point.depth;
    row.weight = point.weight;
    file_->add(row);
  }
}

}  // namespace ist::cli
