#include "support/zip_file.h"

#include <zlib.h>

#include <charconv>
#include <stdexcept>

namespace ist::test {
namespace {

void append(std::string& bytes, std::size_t value, int size) {
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

std::string spelled(double coordinate) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, coordinate).ptr};
}

}  // namespace

std::string as_zip(const std::string& name, const std::string& content, bool deflated,
                   std::uint32_t claimed) {
  const std::string packed = deflated ? deflate_of(content) : content;
  const std::size_t checksum =
      crc32_z(0, reinterpret_cast<const Bytef*>(content.data()), content.size());
  std::string shared;  // what the entry and the directory say alike
  for (const std::size_t half : {std::size_t{20}, std::size_t{0}, std::size_t{deflated ? 8u : 0u},
                                 std::size_t{0}, std::size_t{0}})
    append(shared, half, 2);
  append(shared, checksum, 4);
  append(shared, packed.size(), 4);
  append(shared, claimed != 0 ? claimed : content.size(), 4);
  append(shared, name.size(), 2);
  append(shared, 0, 2);
  std::string bytes = "PK\3\4" + shared + name + packed;
  const std::size_t directory = bytes.size();
  bytes += "PK\1\2";
  append(bytes, 20, 2);
  bytes += shared + std::string(14, '\0') + name;  // of which the last four are the offset
  const std::size_t length = bytes.size() - directory;
  bytes += "PK\5\6" + std::string(4, '\0');
  append(bytes, 1, 2);
  append(bytes, 1, 2);
  append(bytes, length, 4);
  append(bytes, directory, 4);
  append(bytes, 0, 2);
  return bytes;
}

std::string as_3mf(const std::string& model) { return as_zip("3D/3dmodel.model", model); }

std::string threemf_model(const TriangleMesh& mesh) {
  std::string xml =
      "<?xml version=\"1.0\"?>\n<model unit=\"millimeter\">\n<resources>\n"
      "<object id=\"1\">\n<mesh>\n<vertices>\n";
  for (const Eigen::Vector3d& v : mesh.vertices)
    xml += "<vertex x=\"" + spelled(v.x()) + "\" y=\"" + spelled(v.y()) + "\" z=\"" +
           spelled(v.z()) + "\"/>\n";
  xml += "</vertices>\n<triangles>\n";
  for (const auto& [a, b, c] : mesh.triangles)
    xml += "<triangle v1=\"" + std::to_string(a) + "\" v2=\"" + std::to_string(b) + "\" v3=\"" +
           std::to_string(c) + "\"/>\n";
  return xml +
         "</triangles>\n</mesh>\n</object>\n</resources>\n<build><item objectid=\"1\"/></build>\n"
         "</model>\n";
}

}  // namespace ist::test
