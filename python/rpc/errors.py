# SPDX-License-Identifier: BSD-3-Clause
"""The one exception of this module."""

REMEDIES = {
    1: "look for a full disk or too little memory; the console text of the run ends with what it did last",
    2: "mend the parameter, the file or the folder that the message names; `rpc --print-parameters` lists all parameters",
    3: "mend the mesh, or the parameters of \"Mesh\"",
    4: "doc/robustness.md has a remedy for each reason; run(..., check=False) returns what has been computed up to there",
    5: "hold the body by prescribed displacements, or lower the load below what the foundation carries",
    -9: "if nobody has killed it, memory has run out: take fewer cells, or more ranks on more machines",
}
SIGNALLED = "run it again; results of load steps before that are in its folder"
NOT_STARTED = "rpc itself has said nothing: the launcher in $RPC_MPIRUN, by default mpirun, or the system has refused to run it"


class Error(Exception):
    """A run without the result that was asked for, or input that this module refuses before there is a run.

    code     exit code of the program, see doc/input/results.md: 1 internal error, 2 bad input, 3 bad mesh, 4 not converged, 5 no solution; -9 and the like
             where a signal has ended it; None where nothing was run
    message  what the program said, in one line without its name, or what is wrong with the input
    remedy   what helps in general after such an end; "" where the message says it
    result   what the run has left all the same, a Result; None where nothing was run
    """

    def __init__(self, message, code=None, remedy="", result=None):
        super().__init__(message, code, remedy)
        self.message, self.code, self.remedy, self.result = message, code, remedy, result

    def __str__(self):
        text = self.message if self.code is None else f"exit code {self.code}: {self.message}"
        if not self.remedy:
            return text
        return f"{text if text.endswith('...') else text.removesuffix('.')}; remedy: {self.remedy}"


def remedy_of(code, said):
    """@param said  whether the program itself has said why: else a launcher or the system has not let it"""
    if code == 0:
        return ""
    return REMEDIES.get(code, SIGNALLED) if code < 0 else REMEDIES.get(code, NOT_STARTED) if said else NOT_STARTED
