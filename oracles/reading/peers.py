"""Times a reader of another program on a file; prints one JSON document.

    python peers.py PROGRAM FILE SECONDS

PROGRAM is one of READERS below. Each call reads the whole file from its path into the arrays or tables that the program
gives its users; it is repeated for SECONDS, three times at least, after one call that is not counted. Run under the
Python that has the program; `table.py` does that.
"""
import json
import sys
import time


def bytes_alone(path):
    with open(path, "rb") as file:
        return len(file.read())


def with_ezc3d():
    import ezc3d
    from importlib.metadata import version

    def read(path):
        trial = ezc3d.c3d(path)
        # Millimetres and scaled samples, as arrays.
        return trial["data"]["points"].size + trial["data"]["analogs"].size

    return version("ezc3d"), read


def with_sqzc3d():
    import sqzc3d
    from importlib.metadata import version
    return version("sqzc3d"), sqzc3d.read


def opensim():
    import opensim
    opensim.Logger.setLevelString("Error")
    return opensim


def with_opensim_trc():
    program = opensim()

    def read(path):
        return program.TimeSeriesTableVec3(path).getNumRows()

    return program.GetVersion(), read


def with_opensim_table():
    program = opensim()

    def read(path):
        return program.TimeSeriesTable(path).getNumRows()

    return program.GetVersion(), read


def with_opensim_storage():
    program = opensim()

    def read(path):
        return program.Storage(path).getSize()

    return program.GetVersion(), read


def with_opensim_c3d():
    program = opensim()
    if not hasattr(program, "C3DFileAdapter"):
        raise SystemExit("this build of OpenSim has no C3DFileAdapter")
    adapter = program.C3DFileAdapter()

    def read(path):
        tables = adapter.read(path)
        return adapter.getMarkersTable(tables).getNumRows() + adapter.getForcesTable(tables).getNumRows()

    return program.GetVersion(), read


def with_pandas():
    import pandas
    # The numbers alone, by its parser in C: the rows behind the names.

    def read(path):
        skipped = 5 if path.endswith(".trc") else None
        if skipped is None:
            with open(path) as file:
                skipped = next(number for number, line in enumerate(file) if line.strip().lower() == "endheader") + 2
        return pandas.read_csv(path, sep="\t", skiprows=skipped, header=None, engine="c").size

    return pandas.__version__, read


READERS = {"bytes": lambda: (sys.version.split()[0], bytes_alone), "ezc3d": with_ezc3d, "sqzc3d": with_sqzc3d,
           "opensim-c3d": with_opensim_c3d, "opensim-trc": with_opensim_trc, "opensim-table": with_opensim_table,
           "opensim-storage": with_opensim_storage, "pandas": with_pandas}


def main():
    program, path, seconds = sys.argv[1], sys.argv[2], float(sys.argv[3])
    version, read = READERS[program]()
    read(path)
    times, start = [], time.perf_counter()
    while len(times) < 3 or time.perf_counter() - start < seconds:
        begin = time.perf_counter()
        result = read(path)
        times.append(time.perf_counter() - begin)
        del result
    times.sort()
    print(json.dumps({"program": program, "version": version, "calls": len(times), "best_ms": round(times[0] * 1e3, 4),
                      "median_ms": round(times[len(times) // 2] * 1e3, 4)}))


if __name__ == "__main__":
    main()
