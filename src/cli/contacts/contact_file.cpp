#include "cli/contacts/contact_file.h"

#include <array>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/answers/json_text.h"
#include "cli/formats/csv_writer.h"
#include "cli/formats/format.h"
#include "cli/formats/ply_writer.h"
#include "cli/formats/poly_data.h"
#include "cli/formats/vtp_writer.h"
#include "ist/base/files.h"

namespace ist::cli {
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

}  // namespace

void check_contact_file(const std::filesystem::path& file) {
  static_cast<void>(format_by_ending("--contacts", file, kContactFormats));
}

std::unique_ptr<ContactFile> open_contact_file(const std::filesystem::path& file) {
  const FileFormat format = format_by_ending("--contacts", file, kContactFormats);
  if (format == FileFormat::kJsonl) return std::make_unique<JsonlFile>(file);
  if (format == FileFormat::kCsv) return std::make_unique<CsvFile>(file);
  return std::make_unique<PointFile>(file, format);
}

}  // namespace ist::cli
