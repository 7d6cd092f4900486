#include "sweep/sweep_record.h"

#include <nlohmann/json.hpp>

#include "ist/base/files.h"
#include "ist/base/throw_error.h"

namespace ist {
namespace {

using Json = nlohmann::ordered_json;

const char* name_of(ColumnType type) {
  switch (type) {
    case ColumnType::kUint64:
      return "uint64";
    case ColumnType::kInt32:
      return "int32";
    default:
      return "float64";
  }
}

Json object_of(const SweepIdentity& identity, const RowLayout& layout) {
  Json columns = Json::array();
  for (const Column& column : layout.columns) {
    columns.push_back({{"name", column.name}, {"type", name_of(column.type)}});
  }
  return {{"sweep", identity.hash},    {"version", IST_VERSION},
          {"rows", identity.rows},     {"rows_per_part", identity.rows_per_part},
          {"parts", identity.parts()}, {"columns", std::move(columns)}};
}

std::string text_of(const Json& json) { return json.dump(1) + "\n"; }

[[noreturn]] void fail_record(const std::filesystem::path& file) {
  throw_error(ErrorCode::kInputInvalid,
              "{}: the file is damaged, or no record of a sweep: remove it{}", file.string(),
              file.filename() == "sweep.json" ? "; the next run writes it anew"
                                              : ", and the part beside it, to make the part anew");
}

Json read_object(const std::filesystem::path& file) {
  constexpr std::uint64_t kMost = 1 << 24;  // bytes
  InputFile input(file);
  if (input.size() > kMost) fail_record(file);
  Json json = Json::parse(input.read_rest(), nullptr, false);
  if (!json.is_object()) fail_record(file);
  return json;
}

std::string text_in(const Json& json, const char* key, const std::filesystem::path& file) {
  if (!json.contains(key) || !json[key].is_string()) fail_record(file);
  return json[key].get<std::string>();
}

std::uint64_t whole_in(const Json& json, const char* key, const std::filesystem::path& file) {
  if (!json.contains(key) || !json[key].is_number_unsigned()) fail_record(file);
  return json[key].get<std::uint64_t>();
}

}  // namespace

std::string json_of(const PartRecord& record) {
  return text_of({{"sweep", record.sweep},
                  {"part", record.part},
                  {"rows", record.rows},
                  {"xxh3_128", record.checksum},
                  {"seconds", record.seconds}});
}

PartRecord read_part_record(const std::filesystem::path& file) {
  const Json json = read_object(file);
  if (!json.contains("seconds") || !json["seconds"].is_number()) fail_record(file);
  return {text_in(json, "sweep", file), whole_in(json, "part", file), whole_in(json, "rows", file),
          text_in(json, "xxh3_128", file), json["seconds"].get<double>()};
}

std::string json_of(const SweepIdentity& identity, const RowLayout& layout) {
  return text_of(object_of(identity, layout));
}

void require_same_sweep(const std::filesystem::path& file, const SweepIdentity& identity) {
  const Json json = read_object(file);
  const std::string hash = text_in(json, "sweep", file), version = text_in(json, "version", file);
  if (hash != identity.hash) {
    throw_error(ErrorCode::kInputInvalid,
                "{}: the folder is of another sweep, {}, and this one is {}: a tree, "
                "a pose or a question changed; give another folder",
                file.string(), hash, identity.hash);
  }
  if (version != IST_VERSION) {
    throw_error(ErrorCode::kInputInvalid,
                "{}: version {} of ist began this folder, and this is {}: go on with "
                "that version, or give another folder",
                file.string(), version, IST_VERSION);
  }
}

std::string manifest_of(const SweepIdentity& identity, const RowLayout& layout,
                        const std::vector<std::string>& parts, const std::string& npy) {
  Json json = object_of(identity, layout);
  json["xxh3_128"] = {{"rows.npy", npy}, {"parts", parts}};
  return text_of(json);
}

}  // namespace ist
