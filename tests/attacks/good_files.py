"""A good file of each kind that is read, to be altered."""

import base64
import io
import json
import zlib
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import scipy.sparse as sp
from PIL import Image
from scipy.io import mmwrite

import mbs.roads
import mbs.vehicle
import mbs.worlds
from mbs import compile
from mbs.scenes.slider_crank import build
from mbs.system.compiled_model import HEADER
from tests.viewer.hand_scenes import everything

CAR = Path(mbs.vehicle.__file__).with_name("cars") / "saloon"
GOOD: dict[str, bytes] = {
    "car": (CAR / "car.toml").read_bytes(),
    "record of a result": b'{"fmu": "a.fmu", "set": [], "outputs_from": "y", "start": {"m": 1.5}, "held": ["u"], '
    b'"jumps": {"0": [0.0, 1.0]}, "state": {"file": "r.state", "time": 0.1}, "step_s": 0.01, '
    b'"interval_s": 0.01, "lost": []}',
    "events of a recording": b'{"kind": "note", "time": 0.1, "text": "a"}\n{"kind": "reset", "time": 0.2, "text": "b", '
    b'"epoch": 1, "start": {"m": 1.5}}\n',
    "manoeuvre": b'"time","steering","brake"\n# held: brake\n# step: 0.01\n0,0,0\n0.5,1,0\n0.5,2,1\n1,0,0\n',
    "rows of a recording": b"time,count,epoch,u\n0,0,0,1.5\n0.01,1,0,2.5\n0.02,2,0,-1\n",
    "log": b"time;u\n" + b"".join(b"%d;%d,5\n" % (k, k * k) for k in range(40)),
    "alias file of a log": b'[time]\nname = "t"\nunit = "ms"\n[signals]\n"u" = { name = "c", factor = 2.0 }\n',
}


def _bytes_of(write: Callable[[io.BytesIO], object]) -> bytes:
    buffer = io.BytesIO()
    write(buffer)
    return buffer.getvalue()


def _output4() -> bytes:
    """A matrix of 3 x 3 as text."""
    lines = ["       3       3       2       2KGG     1P,3E23.16"]
    for column in (1, 2, 3):
        lines += [f"{column:8d}       1       3", "".join(f"{row * column + 1.0:23.16E}" for row in (1, 2, 3))]
    return "\n".join([*lines, "       4       1       1", f"{1.0:23.16E}", ""]).encode()


def _gltf() -> bytes:
    points = base64.b64encode(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], "<f4").tobytes()).decode()
    return json.dumps(
        {
            "asset": {"version": "2.0"},
            "scene": 0,
            "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
            "buffers": [{"uri": f"data:application/octet-stream;base64,{points}", "byteLength": 36}],
            "bufferViews": [{"buffer": 0, "byteLength": 36}],
            "accessors": [{"bufferView": 0, "count": 3, "componentType": 5126, "type": "VEC3"}],
        }
    ).encode()


_SPARSE = sp.csc_array(np.eye(9) + np.eye(9)[::-1])
GOOD |= {
    "matrix": _bytes_of(lambda out: mmwrite(out, _SPARSE)),
    "matrix of SciPy": _bytes_of(lambda out: sp.save_npz(out, _SPARSE, compressed=False)),
    "grid of NumPy": _bytes_of(lambda out: np.save(out, np.ones((4, 5)))),
    "bulk data": b"CORD2R,5,,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nGRID,1,5,0.,1.,0.\n=,*(1),=,*(0.5),==\n=(3),\n",
    "OUTPUT4": _output4(),
    "deck of CalculiX": b"*HEADING\nx\n*NODE, NSET=N\n1,0.,0.,0.\n2,1.,0.,0.5\n*NSET,NSET=A,GENERATE\n1,2,1\n",
    "mesh of glTF": _gltf(),
}


def _parquet(columns: dict[str, list[float]]) -> bytes:
    return _bytes_of(lambda out: pq.write_table(pa.table(columns), out))


_ROADS = Path(mbs.roads.__file__).parent / "files"
_CRG = Path(__file__).parents[1] / "data" / "crg" / "handmade_straight_minimalist.crg"
GOOD |= {
    "alias file": b'[start]\n"a" = 1.0\n[names]\nsteering = { name = "wheel", factor = 2.0, unit = "rad" }\n',
    "study": b"car = 'prototype'\nstep = 0.01\n[[manoeuvres]]\nname = 'a'\nstop_time = 1.0\n[sampling]\n"
    b"method = 'sobol'\nruns = 8\n[parameters]\n'm' = { range = [1.0, 2.0] }\n[measures]\na = 'max(y)'\n",
    "road in words": (_ROADS / "rough.toml").read_bytes(),
    "world": (Path(mbs.worlds.__file__).parent / "proving_ground.toml").read_bytes(),
    "device": b"format = 'ALi3 device'\nversion = 1\n[inputs.steering]\nsource = 'axis 0'\nlow = -1.0\n",
    "scene": json.dumps(everything()).encode(),
    "record of a study": b'{"name": "a", "file": "a.toml", "fmu": "a.fmu", "runs": 8, "limits": {"a": [0.0, 1.0]}}',
    "recording": b'{"format": "ALi3 recording", "version": 2, "fmu": "a.fmu", "guid": "", "inputs": 1, "step": 0.01, '
    b'"start": {"m": 1.0}, "columns": ["u"], "every": [1], "units": {"u": "1"}, "closed": true, "events": 0}',
    "rows in Parquet": _parquet({"time": [0.0, 0.01], "count": [0, 1], "epoch": [0, 0], "u": [1.0, 2.0]}),
    "result": b"time,u,y\n0,0,1\n0.5,1,2\n1,2,3\n",
    "log in Parquet": _parquet({"time": [0.1 * k for k in range(40)], "u": [0.5 * k for k in range(40)]}),
    "points of a study": b"mass\n1\n2\n3\n",
    "trajectory": b"time [s],u [m]\n0,1\n1,2\n2,3\n",
    "curve of an axle": b"travel [m],toe_angle_left [rad]\n-0.1,0\n0,0.01\n0.1,0.02\n",
    "table of a car": b"joint,x\nA,0.5\nB,-0.5\n",
    "course": b"x,y,width\n0,0,5\n10,0,5\n20,5,6\n",
    "grid": b"0,0,1\n1,2,3\n",
    "grid of a picture": _bytes_of(lambda out: Image.fromarray(np.eye(16, dtype=np.uint8)).save(out, "png")),
    "OpenCRG": _CRG.read_bytes(),
    "road of a mesh": b"ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    b"element face 2\nproperty list uchar int vertex_indices\nend_header\n"
    b"0 0 0\n9 0 0\n0 9 0\n9 9 0\n3 0 1 2\n3 1 3 2\n",
    "nodes": b"name,x,y,z\nA,0,0,1\nB,1,0,0\n",
    "road": (_ROADS / "kerb.road").read_bytes(),
    "System": compile(build()).to_bytes(),
    "mesh": b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
    b"endloop\nendfacet\nendsolid\n",
    "parameter set": b'<?xml version="1.0"?><ssv:ParameterSet xmlns:ssv="http://ssp-standard.org/SSP1/SystemStructure'
    b'ParameterValues" version="1.0" name="a"><ssv:Parameters><ssv:Parameter name="m"><ssv:Real value="1.5" unit="kg"/>'
    b"</ssv:Parameter></ssv:Parameters></ssv:ParameterSet>",
    "function": b"def f(result, parameters):\n    return 1.0\n\nf.units = 'm'\n",
}


def _with_checksum(content: bytes) -> bytes:
    """A System file whose size and checksum fit what was altered in it."""
    if len(content) < HEADER.size:
        return content
    magic, version, count, _, _, zero = HEADER.unpack_from(content)
    body = content[HEADER.size :]
    return HEADER.pack(magic, version, count, len(content), zlib.crc32(body), zero) + body


MENDED: dict[str, Callable[[bytes], bytes]] = {"System": _with_checksum}
"""What makes an altered file one whose checksum does not betray it."""
