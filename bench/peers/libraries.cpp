#include "peers/libraries.h"

namespace ist::bench {

std::vector<Library> libraries() {
  std::vector<Library> all{ist_library()};
#ifdef IST_PEER_FCL
  all.push_back(fcl_library());
#endif
#ifdef IST_PEER_EMBREE
  all.push_back(embree_library());
#endif
#ifdef IST_PEER_BULLET
  all.push_back(bullet_library());
#endif
#ifdef IST_PEER_CGAL
  all.push_back(cgal_library());
#endif
#ifdef IST_PEER_OPENVDB
  all.push_back(openvdb_library());
#endif
  return all;
}

std::string missing_libraries() { return IST_PEERS_MISSING; }
std::string library_flags() { return IST_PEERS_FLAGS; }

}  // namespace ist::bench
