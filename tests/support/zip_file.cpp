#include "support/zip_file.h"

#include <zlib.h>

#include <charconv>
#include <stdexcept>

namespace ist::test {
namespace {

void append_bytes(std::string& bytes, std::size_t value, int size) {
  for (int i = 0; i < size; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xFF);
}

std::string deflate_of(const std::string& content) {
  z_stream stream{};
  if (deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, -MAX_WBITS, 9, Z_DEFAULT_STRATEGY) !=
      Z_OK)
    throw std::runtime_error("zlib");
  std::string packed(deflateBound(&stream, content.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data()));
  stream.avail_in = static_cast<uInt>(content.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  if (deflate(&stream, Z_FINISH) != Z_STREAM_END) throw std::runtime_error("zlib");
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

constexpr std::size_t kElsewhere = 0xFFFFFFFF;  // the number stands in a field of 64 bits

std::size_t claimed_size(const ZipPart& part) {
  return part.claimed != 0 ? part.claimed : part.content.size();
}

// What an entry and the directory say alike, up to the lengths of the name and the extra field.
std::string shared_fields(const ZipPart& part, std::size_t packed, std::size_t extra, bool wide) {
  std::string bytes;
  for (const std::size_t half :
       {std::size_t{wide ? 45u : 20u}, std::size_t{0}, std::size_t{part.deflated ? 8u : 0u},
        std::size_t{0}, std::size_t{0}})
    append_bytes(bytes, half, 2);
  append_bytes(bytes,
               crc32_z(0, reinterpret_cast<const Bytef*>(part.content.data()), part.content.size()),
               4);
  append_bytes(bytes, wide ? kElsewhere : packed, 4);
  append_bytes(bytes, wide ? kElsewhere : claimed_size(part), 4);
  append_bytes(bytes, part.name.size(), 2);
  append_bytes(bytes, extra, 2);
  return bytes;
}

// The extra field of ZIP64.
std::string wide_numbers(const std::vector<std::size_t>& numbers) {
  std::string bytes;
  append_bytes(bytes, 1, 2);
  append_bytes(bytes, 8 * numbers.size(), 2);
  for (const std::size_t number : numbers) append_bytes(bytes, number, 8);
  return bytes;
}

std::string spelled_double(double coordinate) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, coordinate).ptr};
}

}  // namespace

std::string as_zip(const std::vector<ZipPart>& parts, ZipNumbers numbers) {
  const bool wide = numbers == ZipNumbers::kWide;
  std::string bytes, directory;
  for (const ZipPart& part : parts) {
    const std::string packed = part.deflated ? deflate_of(part.content) : part.content;
    const std::size_t offset = bytes.size(), size = claimed_size(part);
    const std::string local = wide ? wide_numbers({size, packed.size()}) : "";
    const std::string central = wide ? wide_numbers({size, packed.size(), offset}) : "";
    bytes += "PK\3\4" + shared_fields(part, packed.size(), local.size(), wide);
    bytes += part.name + local + packed;
    directory += "PK\1\2";
    append_bytes(directory, 20, 2);
    directory += shared_fields(part, packed.size(), central.size(), wide) + std::string(10, '\0');
    append_bytes(directory, wide ? kElsewhere : offset, 4);
    directory += part.name + central;
  }
  const std::size_t begin = bytes.size(), end = begin + directory.size();
  bytes += directory;
  if (wide) {
    bytes += "PK\6\6";
    append_bytes(bytes, 44, 8);  // bytes that follow
    append_bytes(bytes, 45, 2);
    append_bytes(bytes, 45, 2);
    append_bytes(bytes, 0, 8);  // disks
    append_bytes(bytes, parts.size(), 8);
    append_bytes(bytes, parts.size(), 8);
    append_bytes(bytes, directory.size(), 8);
    append_bytes(bytes, begin, 8);
    bytes += "PK\6\7" + std::string(4, '\0');
    append_bytes(bytes, end, 8);
    append_bytes(bytes, 1, 4);
  }
  bytes += "PK\5\6" + std::string(4, '\0');
  append_bytes(bytes, parts.size(), 2);
  append_bytes(bytes, parts.size(), 2);
  append_bytes(bytes, directory.size(), 4);
  append_bytes(bytes, wide ? kElsewhere : begin, 4);
  append_bytes(bytes, 0, 2);
  return bytes;
}

std::string as_zip(const std::string& name, const std::string& content, bool deflated,
                   std::uint32_t claimed) {
  return as_zip({{name, content, deflated, claimed}});
}

std::string as_3mf(const std::string& model) { return as_zip("3D/3dmodel.model", model); }

std::string threemf_model(const TriangleMesh& mesh) {
  std::string xml =
      "<?xml version=\"1.0\"?>\n<model unit=\"millimeter\">\n<resources>\n"
      "<object id=\"1\">\n<mesh>\n<vertices>\n";
  for (const Eigen::Vector3d& v : mesh.vertices)
    xml += "<vertex x=\"" + spelled_double(v.x()) + "\" y=\"" + spelled_double(v.y()) + "\" z=\"" +
           spelled_double(v.z()) + "\"/>\n";
  xml += "</vertices>\n<triangles>\n";
  for (const auto& [a, b, c] : mesh.triangles)
    xml += "<triangle v1=\"" + std::to_string(a) + "\" v2=\"" + std::to_string(b) + "\" v3=\"" +
           std::to_string(c) + "\"/>\n";
  return xml +
         "</triangles>\n</mesh>\n</object>\n</resources>\n<build><item objectid=\"1\"/></build>\n"
         "</model>\n";
}

}  // namespace ist::test
