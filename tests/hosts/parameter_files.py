"""Parameter sets (SSV) written by hand."""

HEAD = (
    '<ssv:ParameterSet xmlns:ssv="http://ssp-standard.org/SSP1/SystemStructureParameterValues" '
    'xmlns:ssc="http://ssp-standard.org/SSP1/SystemStructureCommon" version="{}" name="test"><ssv:Parameters>'
)


UNITS = (
    '<ssv:Units><ssc:Unit name="kN/m"><ssc:BaseUnit kg="1" s="-2" factor="1000"/></ssc:Unit>'
    '<ssc:Unit name="mm"><ssc:BaseUnit m="1" factor="0.001"/></ssc:Unit>'
    '<ssc:Unit name="inch"><ssc:BaseUnit m="1" factor="0.0254"/></ssc:Unit>'
    '<ssc:Unit name="m"><ssc:BaseUnit m="1" factor="10"/></ssc:Unit>'
    '<ssc:Unit name="Nm/deg"><ssc:BaseUnit kg="1" m="2" s="-2" rad="-1" factor="57.29577951308232"/></ssc:Unit>'
    '<ssc:Unit name="1/s2"><ssc:BaseUnit s="-2"/></ssc:Unit></ssv:Units>'
)


def ssv(*entries: str, units: str = UNITS, version: str = "1.0") -> str:
    """A document of ``name=value[unit]`` entries, or of XML elements."""
    body = ""
    for entry in entries:
        if entry.startswith("<"):
            body += entry
            continue
        name, _, rest = entry.partition("=")
        value, bracket, unit = rest.partition("[")
        attribute = f' unit="{unit[:-1]}"' if bracket else ""
        body += f'<ssv:Parameter name="{name}"><ssv:Real value="{value}"{attribute}/></ssv:Parameter>'
    return f"{HEAD.format(version)}{body}</ssv:Parameters>{units}</ssv:ParameterSet>"
