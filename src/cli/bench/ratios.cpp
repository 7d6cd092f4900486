#include "cli/bench/ratios.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>

#include "cli/bench/contestants.h"

namespace ist::cli {
namespace {

struct Wanted {
  std::string_view question, way, spheres;
  int workers = 1;
};

std::optional<std::size_t> find(const std::vector<Contestant>& among, const Wanted& wanted) {
  const auto found = std::ranges::find_if(among, [&wanted](const Contestant& each) {
    return each.question == wanted.question && each.way == wanted.way &&
           each.spheres == wanted.spheres && each.workers == wanted.workers;
  });
  if (found == among.end()) return std::nullopt;
  return static_cast<std::size_t>(found - among.begin());
}

void add(RatioGroup& group, std::string words, const std::vector<Contestant>& among,
         const Wanted& of, const Wanted& over) {
  const auto a = find(among, of), b = find(among, over);
  if (a && b) group.ratios.push_back({std::move(words), *a, *b});
}

RatioGroup to_published(const std::vector<Contestant>& among) {
  RatioGroup group{"leaf pairs: IST's spheres against the published query's", {}};
  std::string_view tightest;
  for (const SpherePolicy policy : kSpherePolicies) {
    const std::string_view spheres = to_string(policy);
    const Wanted fast{"leaf pairs", kFastWay, spheres};
    if (!find(among, fast)) continue;
    tightest = spheres;
    add(group, fmt::format("{0} against {0}", spheres), among, fast,
        {"leaf pairs", kPublishedWay, spheres});
  }
  const Wanted table{"leaf pairs", kPublishedWay, to_string(SpherePolicy::kTable)};
  for (const int workers : {1, 2}) {
    if (workers == 1 && tightest == to_string(SpherePolicy::kTable)) continue;  // as above
    add(group, fmt::format("{} against table{}", tightest, workers == 2 ? ", two workers" : ""),
        among, {"leaf pairs", kFastWay, tightest, workers}, table);
  }
  return group;
}

RatioGroup to_search(const std::vector<Contestant>& among) {
  RatioGroup group{"contacts, a tick of a hand that trembles", {}};
  for (const Contestant& each : among) {
    if (each.way != kKeptWay) continue;
    add(group, "pairs kept against a search", among, {each.question, kKeptWay, each.spheres},
        {each.question, kSearchWay, each.spheres});
  }
  return group;
}

RatioGroup to_rivals(const std::vector<Contestant>& among) {
  RatioGroup group{"triangles: IST against other libraries", {}};
  for (const Contestant& each : among) {
    const bool own = each.way == kFastWay || each.way == kPublishedWay || each.way == kSearchWay ||
                     each.way == kKeptWay;
    if (own) continue;
    add(group, fmt::format("{}, against {}", each.question, each.way), among,
        {each.question, kFastWay, ""}, {each.question, each.way, ""});
  }
  return group;
}

}  // namespace

std::vector<RatioGroup> ratios_of(const std::vector<Contestant>& contestants) {
  std::vector<RatioGroup> all;
  for (RatioGroup group :
       {to_published(contestants), to_search(contestants), to_rivals(contestants)}) {
    if (!group.ratios.empty()) all.push_back(std::move(group));
  }
  return all;
}

}  // namespace ist::cli
