"""What a program shows on a terminal."""
import fcntl
import os
import pty
import struct
import subprocess
import termios


def shown_on_terminal(test, command, stream, columns=80, **options):
    """What the command writes to `stream`, "stdout" or "stderr", where that is a terminal of so many columns. Skips the test on
    a machine that gives no terminals."""
    try:
        ours, theirs = pty.openpty()
    except OSError as error:
        test.skipTest(f"skipped: this machine gives no terminals ({error})")
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
    shown = b""
    with subprocess.Popen(command, **{stream: theirs}, **options) as process:
        os.close(theirs)
        try:
            while part := os.read(ours, 65536):
                shown += part
        except OSError:
            pass  # the other end is closed
    os.close(ours)
    test.assertEqual(process.returncode, 0)
    return shown.decode()
