// The functions that page/worker.js calls. Errors are texts: no exception leaves.

#include <emscripten.h>
#include <sys/stat.h>

#include <new>
#include <nlohmann/json.hpp>

#include "answers/engine.h"
#include "answers/json_parts.h"
#include "answers/version.h"
#include "ist/base/error.h"
#include "viewer/engine/session.h"

namespace {

using ist::viewer::Asked;
using ist::viewer::Reply;
using ist::viewer::Session;

// clang-format off
EM_JS(void, tell_progress, (const char* stage, double part), {
  Module.progress(UTF8ToString(stage), part);
});
// clang-format on

Session& session() {
  static Session made;
  return made;
}

// The last answer, whose arrays the worker copies before it asks again, and its text.
Reply& last_reply() {
  static Reply reply;
  return reply;
}
std::string& last_text() {
  static std::string text;
  return text;
}

const char* keep(const nlohmann::ordered_json& json) {
  last_text() = ist::answers::json_text(json);
  return last_text().c_str();
}

const char* keep_error(const char* code, const std::string& text) {
  return keep({{"error", {{"code", code}, {"text", text}}}});
}

}  // namespace

extern "C" {

/// Makes the folders that files are written to, and returns {"version", "target"}.
EMSCRIPTEN_KEEPALIVE const char* ist_page_start() {
  mkdir("fixed", 0700);
  mkdir("moving", 0700);
  return keep(
      {{"version", ist::answers::version_words()}, {"target", ist::answers::target_names()}});
}

/// Answers a question: {"answer": …}, or {"error": {"code", "text"}}. Arrays are valid until the
/// next call.
EMSCRIPTEN_KEEPALIVE const char* ist_page_answer(const char* question, const char* asked) {
  try {
    ist::Progress progress;
    progress.watch([&progress] { tell_progress(progress.stage(), progress.fraction()); });
    last_reply() = {};
    last_reply() = session().answer(question, Asked(asked), progress);
    return keep({{"answer", last_reply().json}});
  } catch (const ist::Error& error) {
    return keep_error(to_string(error.code()), error.what());
  } catch (const std::bad_alloc&) {
    return keep_error("memory-limit",
                      "the page's memory is full: take larger voxels, or use the command");
  } catch (const std::exception& error) {
    return keep_error("argument-invalid", error.what());
  }
}

}  // extern "C"
