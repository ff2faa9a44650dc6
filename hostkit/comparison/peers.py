"""The peers that hostkit knows, and how a user names them."""

from typing import Final

from hostkit.comparison.ahrs_peers import AHRS_PEERS
from hostkit.comparison.imufusion_peer import FUSION_PEER
from hostkit.comparison.peer import Peer
from hostkit.comparison.vqf_peers import VQF_PEERS
from hostkit.errors import HostkitError
from hostkit.registry import Registry

PEERS: Registry[Peer] = Registry("peer", (*VQF_PEERS, FUSION_PEER, *AHRS_PEERS))

USUAL: Final = ("vqf-online", "vqf-offline", "imufusion", "mahony", "madgwick")


def chosen_peers(names: tuple[str, ...]) -> tuple[Peer, ...]:
    """Return peers by their names, or all of a package by its name.

    Raises
    ------
    HostkitError
        If nothing has a name.
    """
    found: list[Peer] = []
    for name in names:
        own = [peer for peer in PEERS if name in (peer.name, peer.package)]
        if not own:
            packages = sorted({peer.package for peer in PEERS})
            raise HostkitError(
                f"no peer {name!r}; there are {', '.join(PEERS.names())}, "
                f"and all of a package: {', '.join(packages)}"
            )
        found += [peer for peer in own if peer not in found]
    return tuple(found)
