// read_mesh() beside an importer that misbehaves, and in hosts of every kind. Nothing may stay
// behind: no process, no zombie, no file descriptor.

#include <dirent.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "import/fake_importer.h"
#include "ist/base/cancellation.h"
#include "ist/base/error.h"
#include "ist/mesh/import/import_run.h"
#include "ist/mesh/mesh.h"
#include "support/errors.h"
#include "support/mesh_files.h"
#include "support/scoped_variable.h"
#include "support/shapes.h"
#include "support/temp_dir.h"

namespace ist {
namespace {

const TriangleMesh kBall = test::icosphere(2, 1);

std::size_t open_files() {
  std::size_t count = 0;
  DIR* folder = ::opendir("/proc/self/fd");
  while (::readdir(folder) != nullptr) ++count;
  ::closedir(folder);
  return count;
}

// Whether this process has no child, not even a zombie.
bool is_childless() { return ::waitpid(-1, nullptr, WNOHANG) < 0 && errno == ECHILD; }

class ImportCaller : public ::testing::Test {
 protected:
  ~ImportCaller() override {
    EXPECT_EQ(open_files(), open_before_);
    EXPECT_TRUE(is_childless());
  }
  std::string refusal() const {
    const auto error = test::error_of([&] { static_cast<void>(read_mesh(file_)); });
    if (!error) return "fine";
    const std::string text = error->what(), name = file_.string() + ": ";
    EXPECT_TRUE(text.starts_with(name)) << text;
    return std::string(to_string(error->code())) + ": " + text.substr(name.size());
  }

  const test::TempDir folder_;
  const std::filesystem::path file_ = folder_.write("jaw.glb", test::as_glb(kBall));

 private:
  const std::size_t open_before_ = open_files();
};

TEST_F(ImportCaller, TakesAnAnswer) {
  const test::FakeImporter importer("cat \"$ANSWER\"", test::FakeMesh().counted().bytes());
  EXPECT_EQ(read_mesh(file_).triangles.size(), 1u);
}

TEST_F(ImportCaller, GivesThePathAndTheContent) {
  const test::FakeImporter importer("[ \"$#\" = 1 ] && [ \"$1\" = '" + file_.string() +
                                        "' ] && cmp -s - \"$1\" && [ \"$LC_ALL\" = C ] && [ -z "
                                        "\"$HOME\" ] && cat \"$ANSWER\"",
                                    test::FakeMesh().counted().bytes());
  EXPECT_EQ(refusal(), "fine");
}

TEST_F(ImportCaller, TellsHowAnImporterEnds) {
  const std::string remedy = ": " + std::string(kConvert);
  const std::string whole = test::FakeMesh().counted().bytes();
  {
    const test::FakeImporter importer("exit 0");
    EXPECT_EQ(refusal(), "file-unreadable: ist-import at " + importer.program().string() +
                             " ended without a complete answer (exit code 0)" + remedy);
  }
  {
    const test::FakeImporter importer("kill -SEGV $$");
    EXPECT_EQ(refusal(),
              "not-a-mesh: the importer ended by signal 11 while it read the file" + remedy);
  }
  {
    const test::FakeImporter importer("kill -XCPU $$");
    EXPECT_EQ(refusal(),
              "mesh-too-large: ist-import took too long to read it, and was ended" + remedy);
  }
  {  // the end of an answer counts, not the end of the program
    const test::FakeImporter importer("cat \"$ANSWER\"; kill -SEGV $$", whole);
    EXPECT_EQ(refusal(), "fine");
  }
  {
    const test::FakeImporter importer("cat \"$ANSWER\"; exec >&-; sleep 1000", whole);
    EXPECT_EQ(refusal(), "fine");
  }
  {
    const test::FakeImporter importer("head -c 100 \"$ANSWER\"; exit 3", whole);
    EXPECT_NE(refusal().find("without a complete answer (exit code 3)"), std::string::npos);
  }
  {
    const test::FakeImporter importer(
        "echo garbage, and more than a header has, so that it is read "
        "as one: 0123456789; printf IST-DONE");
    EXPECT_NE(refusal().find("gave no mesh that can be trusted"), std::string::npos) << refusal();
  }
}

TEST_F(ImportCaller, RefusesEndlessOutput) {
  const test::FakeImporter importer("exec cat /dev/zero");
  EXPECT_TRUE(refusal().starts_with("mesh-too-large: ist-import made more of it"));
}

TEST_F(ImportCaller, NamesAProgramThatCannotStart) {
  const std::string missing = (folder_.path() / "no importer").string();
  const test::ScopedImporter importer(missing);
  EXPECT_EQ(refusal(), "file-unreadable: ist-import at " + missing +
                           " cannot be started: No such file or directory; install it again, or " +
                           std::string(kConvert));
  const test::ScopedImporter folder(folder_.path().string());
  EXPECT_NE(refusal().find("cannot be started: Permission denied"), std::string::npos);
}

TEST_F(ImportCaller, EndsAnImporterAtItsTime) {
  for (const char* script : {"sleep 1000", "exec >&-; sleep 1000", "while :; do echo x; done"}) {
    const test::FakeImporter importer(script);
    const ImportRun run =
        run_importer(importer.program(), "", file_, std::chrono::milliseconds(300));
    EXPECT_EQ(run.end, ImportRun::End::kTooLate) << script;
  }
}

// The current folder and PATH may be anybody's.
TEST_F(ImportCaller, StartsNoProgramOfTheCurrentFolder) {
  const test::FakeImporter importer("touch '" + (folder_.path() / "started").string() + "'");
  std::filesystem::copy_file(importer.program(), folder_.path() / "ist-import");
  const std::filesystem::path before = std::filesystem::current_path();
  const std::string path = folder_.path().string() + ":" + std::getenv("PATH");
  const test::ScopedVariable scoped_path("PATH", path.c_str());
  std::filesystem::current_path(folder_.path());
  for (const char* named : {"", "ist-import", "./ist-import"}) {
    const test::ScopedImporter relative(named);
    const std::string got = refusal();
    if (*named != '\0') {
      EXPECT_EQ(got, "file-unreadable: the environment variable IST_IMPORT is '" +
                         std::string(named) + "': give an absolute path");
    } else {
      EXPECT_NE(got.find("ist-import, which is not installed: install it"), std::string::npos);
    }
  }
  std::filesystem::current_path(before);
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "started"));
}

// A hanging importer, and a child of its own that holds the pipe, are killed when the caller ends
// the work.
TEST_F(ImportCaller, EndsAtACancellationPoint) {
  const test::FakeImporter importer("echo $$ > '" + (folder_.path() / "id").string() +
                                    "'; sleep 1000 & sleep 1000");
  std::atomic<bool> asked = false;
  std::thread later([&] {
    while (!std::filesystem::exists(folder_.path() / "id"))
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    asked = true;
  });
  {
    const ScopedCancellation scope(asked);
    EXPECT_EQ(test::error_name([&] { static_cast<void>(read_mesh(file_)); }), "cancelled");
  }
  later.join();
  const int id = std::stoi(test::file_content(folder_.path() / "id"));
  for (int i = 0; i < 400 && ::kill(-id, 0) == 0; ++i)  // until the kernel has buried them
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_TRUE(::kill(-id, 0) != 0 && errno == ESRCH);
}

TEST_F(ImportCaller, MayHaveAnyPath) {
  for (const char* name : {"a b.glb", "Z\xE4hne.glb", "\"'$(x)`\\.glb", "-v.glb", "no extension"}) {
    const auto file = folder_.write(name, test::as_glb(kBall));
    EXPECT_EQ(test::corners(read_mesh(file)), test::corners(test::narrowed(kBall))) << name;
  }
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder_.path());
  EXPECT_EQ(read_mesh("-v.glb").triangles.size(), kBall.triangles.size());
  EXPECT_EQ(read_mesh("jaw.glb").triangles.size(), kBall.triangles.size());
  std::filesystem::current_path(before);
}

// The content is read once: the importer sees what the library saw.
TEST_F(ImportCaller, MayReadAFileThatGrows) {
  const test::FakeImporter importer(
      "printf x >> \"$1\"; [ $(wc -c) = " + std::to_string(test::as_glb(kBall).size()) +
          " ] && cat \"$ANSWER\"",
      test::FakeMesh().counted().bytes());
  EXPECT_EQ(refusal(), "fine");
}

TEST_F(ImportCaller, FoldersAndPipesAreRefusedBefore) {
  const test::FakeImporter importer("kill -SEGV $$");
  const auto pipe = folder_.path() / "pipe.glb";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  for (const auto& path : {pipe, folder_.path()})
    EXPECT_EQ(test::error_name([&] { static_cast<void>(read_mesh(path)); }), "file-unreadable");
}

TEST_F(ImportCaller, MayIgnoreSigchld) {
  struct sigaction ignore {
  }, before{};
  ignore.sa_handler = SIG_IGN;
  ::sigaction(SIGCHLD, &ignore, &before);
  EXPECT_EQ(refusal(), "fine");
  {
    const test::FakeImporter importer("kill -SEGV $$");  // of which nothing is known then
    EXPECT_NE(refusal().find("ended without a complete answer: convert"), std::string::npos);
  }
  ::sigaction(SIGCHLD, &before, nullptr);
}

TEST_F(ImportCaller, MayHaveAHostThatWaitsForAllChildren) {
  std::atomic<bool> done = false;
  std::thread reaper([&] {
    while (!done)
      if (::waitpid(-1, nullptr, WNOHANG) <= 0)
        std::this_thread::sleep_for(std::chrono::microseconds(200));
  });
  for (int i = 0; i < 10; ++i) EXPECT_EQ(refusal(), "fine");
  done = true;
  reaper.join();
}

TEST_F(ImportCaller, MayBlockSignalsAndCloseItsStdin) {
  sigset_t all, before;
  sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);
  const int input = ::fcntl(0, F_DUPFD_CLOEXEC, 10);
  ::close(0);
  EXPECT_EQ(refusal(), "fine");
  ::dup2(input, 0);
  ::close(input);
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

TEST_F(ImportCaller, MayHaveManyThreads) {
  std::vector<std::thread> threads;
  std::atomic<int> right = 0;
  for (int i = 0; i < 8; ++i)
    threads.emplace_back([&] {
      for (int j = 0; j < 3; ++j)
        if (read_mesh(file_).triangles.size() == kBall.triangles.size()) ++right;
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(right, 24);
}

TEST_F(ImportCaller, HasNoFileDescriptorsLeft) {
  rlimit before{}, few{};
  ::getrlimit(RLIMIT_NOFILE, &before);
  few = {64, before.rlim_max};
  ::setrlimit(RLIMIT_NOFILE, &few);
  std::vector<int> taken;
  while (taken.empty() || taken.back() >= 0) taken.push_back(::open("/dev/null", O_CLOEXEC));
  taken.pop_back();
  for (int left = 1; left < 5 && !taken.empty(); ++left) {
    ::close(taken.back());
    taken.pop_back();
    const std::string got = refusal();
    EXPECT_TRUE(got == "fine" || got.starts_with("file-unreadable: ")) << left << got;
  }
  for (const int id : taken) ::close(id);
  ::setrlimit(RLIMIT_NOFILE, &before);
}

}  // namespace
}  // namespace ist
