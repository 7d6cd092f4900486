/* Runs a program step by step, for instructions that qemu does not know: prints how many have run
   since the last mark, which is a system call of number 4095, to standard error, as
   counting_plugin.c does. Steps are taken from every other mark to the next alone; a step of a
   string instruction counts as one instruction.

     counting_steps PROGRAM [ARGUMENT…] */
#include <inttypes.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/ptrace.h>
#include <sys/user.h>
#include <sys/wait.h>
#include <unistd.h>

enum { kMark = 4095 };

static void require(int holds, const char* what) {
  if (holds) return;
  perror(what);
  exit(1);
}

/* Whether the program stands before or behind a mark. */
static int at_mark(pid_t program) {
  struct user_regs_struct registers;
  require(ptrace(PTRACE_GETREGS, program, NULL, &registers) == 0, "counting_steps: registers");
  return registers.orig_rax == kMark;
}

/* Goes on in one way until the program stops again; ends with its exit code. */
static void resume(pid_t program, enum __ptrace_request how) {
  int status = 0;
  require(ptrace(how, program, NULL, NULL) == 0, "counting_steps: resume");
  require(waitpid(program, &status, 0) == program, "counting_steps: wait");
  if (WIFEXITED(status)) exit(WEXITSTATUS(status));
  require(WIFSTOPPED(status), "counting_steps: the program was killed");
}

/* Runs to the end of the next mark's system call. */
static void run_past_mark(pid_t program) {
  do resume(program, PTRACE_SYSCALL);
  while (!at_mark(program));
  resume(program, PTRACE_SYSCALL);
}

int main(int argc, char** argv) {
  if (argc < 2) {
    fprintf(stderr, "usage: counting_steps PROGRAM [ARGUMENT...]\n");
    return 2;
  }
  const pid_t program = fork();
  require(program >= 0, "counting_steps: fork");
  if (program == 0) {
    ptrace(PTRACE_TRACEME, 0, NULL, NULL);
    execv(argv[1], argv + 1);
    perror(argv[1]);
    _exit(127);
  }
  require(waitpid(program, NULL, 0) == program, "counting_steps: start");
  for (;;) {
    run_past_mark(program);
    uint64_t count = 0;
    do {
      resume(program, PTRACE_SINGLESTEP);
      ++count;
    } while (!at_mark(program));
    fprintf(stderr, "mark 0\nmark %" PRIu64 "\n", count);
  }
}
