// NULL pointers and handles that are none, for every function that takes one.

#include <array>
#include <map>
#include <string>
#include <type_traits>

#include "capi/c_bodies.h"
#include "ist/capi/ist_measure.h"
#include "ist/capi/ist_models.h"
#include "ist/capi/ist_sweep.h"
#include "ist/capi/ist_world.h"
#include "support/shapes.h"
#include "sweep/sweep_case.h"

namespace ist::test {
namespace {
namespace calls {

/// One handle of each kind, and the path of no file.
struct Sound {
  ist_mesh* mesh = nullptr;
  ist_tree* tree = nullptr;
  ist_query* query = nullptr;
  ist_servo* servo = nullptr;
  ist_world* world = nullptr;
  ist_sweep* sweep = nullptr;
  const char* path = "";
};

/// A call with NULL in place of one argument.
struct NullCall {
  const char *function, *argument;
  ist_status (*call)(const Sound& sound);
};

/// A call with a handle of the caller in place of one argument, which is a handle of `kind`.
struct HandleCall {
  const char *function, *argument, *kind;
  ist_status (*call)(const Sound& sound, void* handle);
};

template <class T>
T* some();
// Sets the members of a struct that a function requires.
template <class T>
void complete(T&) {}
void complete(ist_servo_options& options) { options.unit = IST_UNIT_MM; }
void complete(ist_rows_options& options) { options.questions = IST_ASK_INTERSECTS; }
void complete(ist_motion& motion) { motion.from = motion.to = some<double>(); }

// Returns the memory of an argument: a pose, a struct with its size, or room for an answer.
template <class T>
T* some() {
  static std::array<T, 16> memory;
  memory = {};
  if constexpr (std::is_same_v<T, double>) {
    memory = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  }
  if constexpr (requires { memory[0].struct_size; }) {
    memory[0] = sized<T>();
    complete(memory[0]);
  }
  return memory.data();
}

#include "capi_calls.inc"

}  // namespace calls

class CMisuseOfCalls : public SweepTest {
 protected:
  CMisuseOfCalls() {
    sound_ = made();
    sound_.path = file_.c_str();
  }
  ~CMisuseOfCalls() override { free(sound_); }

  [[nodiscard]] calls::Sound made() const {
    calls::Sound all;
    all.mesh = c_mesh(box({0, 0, 0}, {2, 2, 2}));
    all.tree = c_tree(box({0, 0, 0}, {2, 2, 2}), 0.5);
    all.query = c_query(c_tree(box({0, 0, 0}, {2, 2, 2}), 0.5));
    auto options = sized<ist_servo_options>();
    options.unit = IST_UNIT_MM;
    const std::string scene = dir_.write("scene.toml", kSmallScene).string();
    EXPECT_EQ(name(ist_servo_open_scene(scene.c_str(), &options, &all.servo)), "ok");
    EXPECT_EQ(name(ist_world_create(nullptr, &all.world)), "ok");
    const std::string sweep = dir_.write("job.toml", kSoundSweep).string();
    EXPECT_EQ(name(ist_sweep_open(sweep.c_str(), nullptr, &all.sweep)), "ok")
        << ist_last_error_message();
    return all;
  }
  static void free(const calls::Sound& all) {
    EXPECT_EQ(name(ist_sweep_free(all.sweep)), "ok");
    EXPECT_EQ(name(ist_world_free(all.world)), "ok");
    EXPECT_EQ(name(ist_servo_free(all.servo)), "ok");
    EXPECT_EQ(name(ist_query_free(all.query)), "ok");
    EXPECT_EQ(name(ist_tree_free(all.tree)), "ok");
    EXPECT_EQ(name(ist_mesh_free(all.mesh)), "ok");
  }
  // The handles by the names of their kinds.
  static std::map<std::string, void*> handles_of(const calls::Sound& all) {
    return {{"mesh", all.mesh},   {"tree", all.tree},   {"query", all.query},
            {"servo", all.servo}, {"world", all.world}, {"sweep", all.sweep}};
  }
  // Expects a status, and a message that begins with the function, the argument and `text`.
  template <class Called>
  static void expect(ist_status status, const char* code, const Called& called, const char* text) {
    EXPECT_EQ(name(status), code) << called.function << ": " << called.argument;
    const std::string message = ist_last_error_message();
    const std::string wanted = std::string(called.function) + ": " + called.argument + text;
    EXPECT_EQ(message.substr(0, wanted.size()), wanted);
  }

  const std::string file_ = (dir_.path() / "no.file").string();
  calls::Sound sound_;
};

TEST_F(CMisuseOfCalls, OfANullPointerIsToldByItsName) {
  for (const calls::NullCall& one : calls::kNullCalls) {
    expect(one.call(sound_), "null-argument", one, " is NULL");
  }
  EXPECT_GT(std::size(calls::kNullCalls), 90u);
  EXPECT_EQ(ist_servo_warning(nullptr, 0), nullptr);
}

// Every handle, replaced by NULL, by numbers that are no handles, by handles of each other kind
// and by freed ones.
TEST_F(CMisuseOfCalls, OfAHandleIsToldByItsName) {
  const calls::Sound gone = made();
  free(gone);
  const auto sound = handles_of(sound_), freed = handles_of(gone);
  for (const calls::HandleCall& one : calls::kHandleCalls) {
    const auto call = [&](void* handle) { return one.call(sound_, handle); };
    if (std::string(one.function).ends_with("_free")) {
      EXPECT_EQ(name(call(nullptr)), "ok") << one.function;
    } else {
      expect(call(nullptr), "null-argument", one, " is NULL");
    }
    expect(call(&sound_), "not-a-handle", one, " is not a handle");
    expect(call(reinterpret_cast<void*>(std::uintptr_t{8})), "not-a-handle", one,
           " is not a handle");
    for (const auto& [kind, handle] : freed) {
      if (kind == one.kind) {
        expect(call(handle), "handle-freed", one, " is a ");
      } else {
        expect(call(handle), "handle-kind", one, " is a handle of another kind");
        expect(call(sound.at(kind)), "handle-kind", one, " is a handle of another kind");
      }
    }
  }
  EXPECT_GT(std::size(calls::kHandleCalls), 50u);
  EXPECT_EQ(ist_servo_warning(gone.servo, 0), nullptr);
}

}  // namespace
}  // namespace ist::test
