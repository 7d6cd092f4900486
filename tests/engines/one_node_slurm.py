"""A Slurm of one node, this machine, with files of its own: munged, slurmctld and slurmd run as this user, and end with it."""

import getpass
import os
import pathlib
import secrets
import shutil
import socket
import subprocess
import tempfile
import time

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "scancel", "squeue", "scontrol")
# A job whose command was killed (128 + 9) is requeued. After a node failed only those are that ask for it (JobRequeue).
CONFIGURATION = """
ClusterName=one
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=10
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SwitchType=switch/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
ReturnToService=2
RequeueExit=137
JobRequeue=0
NodeName={host} NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


def program(name):
    """The file of one of Slurm's programs, of which some lie in /usr/sbin. None: it is not there."""
    return shutil.which(name, path=f"{os.environ['PATH']}:/usr/sbin:/sbin")


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for each in sockets:
        each.bind(("127.0.0.1", 0))
    ports = [each.getsockname()[1] for each in sockets]
    for each in sockets:
        each.close()
    return ports


class OneNodeSlurm:
    """`with OneNodeSlurm() as slurm:` starts it and waits until its node is idle; slurm.ask(program, …) asks it."""

    def __enter__(self):
        self.made = tempfile.TemporaryDirectory(prefix="slurm")
        self.folder = pathlib.Path(self.made.name)
        self.folder.chmod(0o755)  # munged wants that all reach its socket
        self.daemons = []
        key = self.folder / "munge.key"
        key.touch(mode=0o600)
        key.write_bytes(secrets.token_bytes(128))
        (self.folder / "state").mkdir()
        (self.folder / "spool").mkdir()
        file = self.folder / "slurm.conf"
        file.write_text(CONFIGURATION.format(host=socket.gethostname().split(".")[0], folder=self.folder,
                                             ports=free_ports(2), user=getpass.getuser()))
        self.environment = dict(os.environ, SLURM_CONF=str(file))
        try:
            self.start("munged", "--foreground", "--num-threads=2", f"--key-file={key}", *(
                f"--{what}={self.folder}/munge.{ending}"
                for what, ending in (("socket", "socket"), ("pid-file", "pid"), ("log-file", "log"), ("seed-file", "seed"))))
            self.wait("munged", (self.folder / "munge.socket").exists)
            self.start("slurmctld", "-D")
            self.start("slurmd", "-D")
            self.wait("the node", lambda: "State=IDLE" in self.try_to("scontrol", "show", "node").stdout)
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        if len(self.daemons) == 3:  # after a failure jobs may run
            self.try_to("scancel", f"--user={getpass.getuser()}")
            end = time.monotonic() + 20
            while time.monotonic() < end and self.try_to("squeue", "--noheader").stdout:
                time.sleep(0.2)
        for daemon in reversed(self.daemons):
            daemon.terminate()
            try:
                daemon.wait(20)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()
        self.made.cleanup()

    def start(self, name, *arguments):
        with open(self.folder / f"{name}.out", "w", encoding="utf-8") as out:
            self.daemons.append(subprocess.Popen([program(name), *arguments], env=self.environment, stdout=out, stderr=out, stdin=subprocess.DEVNULL))

    def wait(self, what, is_there, seconds=300):
        end = time.monotonic() + seconds
        while not is_there():
            if time.monotonic() > end or any(daemon.poll() is not None for daemon in self.daemons):
                logs = "\n".join(f"{file.name}:\n{file.read_text()[-2000:]}" for file in self.folder.glob("*.[lo]*")
                                 if file.suffix in (".log", ".out"))
                raise RuntimeError(f"{what} of a Slurm of one node did not come up:\n{logs}")
            time.sleep(0.1)

    def try_to(self, name, *arguments, cwd=None):
        return subprocess.run([program(name), *map(str, arguments)], env=self.environment, cwd=cwd, capture_output=True, text=True, check=False)

    def ask(self, name, *arguments, cwd=None):
        """Runs one of Slurm's programs and returns what it prints."""
        ran = self.try_to(name, *arguments, cwd=cwd)
        if ran.returncode != 0:
            raise RuntimeError(f"{name} {arguments} ended with {ran.returncode}: {ran.stdout}{ran.stderr}")
        return ran.stdout
