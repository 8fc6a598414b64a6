"""A scheduler of Dask that is there: its client, and whether the traffic is encrypted."""

from __future__ import annotations

import sys

from distributed import Client, Security

from ali3.words import shortened
from hosts.common.errors import HostError

_PATIENCE = 20.0  # s for an answer
_ENCRYPTED = ("tls://", "wss://")


def client_of(address: str) -> Client:
    """A client of the scheduler at an address; `HostError` where nobody answers, or certificates do not fit."""
    _check_encryption(address)
    try:
        return Client(address, timeout=_PATIENCE, set_as_default=False)
    except (OSError, ValueError) as error:
        words = " ".join(str(error).split())
        raise HostError(f"No scheduler of Dask answers at {address}: {words[:200]}") from None


def _check_encryption(address: str) -> None:
    """Refuse an address that does not go with the certificates of Dask's configuration; say where there are none."""
    settings = Security()
    if address.startswith(_ENCRYPTED):
        try:
            context = settings.get_connection_args("client")["ssl_context"]
        except (OSError, ValueError) as error:
            raise HostError(f"The certificates in the configuration of Dask cannot be used: {error}.") from None
        if context is None:
            raise HostError(
                f"The scheduler {address} needs certificates, and the configuration of Dask has none: "
                "distributed.comm.tls.ca-file, .client.cert and .client.key."
            )
    elif settings.require_encryption:
        raise HostError(f"The configuration of Dask demands encryption; {address} has none, tls://... has.")
    else:
        print(
            f"note: The scheduler {shortened(address)} is used without TLS: whoever reaches it or its "
            "workers can run programs as their user. The page on studies of the documentation says how "
            "certificates are set.",
            file=sys.stderr,
        )
