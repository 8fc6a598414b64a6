import sys,time
sys.path.insert(0,"/tmp/combo")
from pathlib import Path
from hosts.fmu import Fmu
from hosts.co_simulation import run, driver_of
from hosts.manoeuvre import load_manoeuvre
from dataclasses import replace
m=replace(load_manoeuvre("slalom"),stop_time=3.0)
with Fmu(Path("/work/dist/PrototypeCar.fmu")) as f:
    print(f.description.defaultExperiment.stepSize, len(f.names("output")))
    for k in range(3):
        if k: f.reset()
        t=time.perf_counter(); r=run(f,replace(m,start={**m.start,"fidelity":0}),0.01,driver_of(f,m)); print(time.perf_counter()-t,r.wall)
