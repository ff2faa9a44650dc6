"""Names that may stand in generated VHDL, Verilog, C and SystemRDL alike."""

import re
from dataclasses import dataclass
from typing import Final

from hostkit.errors import RenderError

LONGEST: Final = 48
"""Characters; with the prefixes of generated names it stays below the 63 that C99 tells apart."""
SHAPE: Final = re.compile(r"[A-Za-z][A-Za-z0-9]*(_[A-Za-z0-9]+)*")
"""VHDL's rule, the strictest: a letter first, underscores one at a time and between others."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Language:
    """A language and the words that it keeps for itself.

    Attributes
    ----------
    name
        For messages.
    listed
        Reserved words in lower case, white space between them.
    """

    name: str
    listed: str

    @property
    def words(self) -> frozenset[str]:
        """Reserved words in lower case."""
        return frozenset(self.listed.split())


VHDL: Final = Language(
    name="VHDL-93",
    listed="""
        abs access after alias all and architecture array assert attribute begin block body buffer
        bus case component configuration constant disconnect downto else elsif end entity exit file
        for function generate generic group guarded if impure in inertial inout is label library
        linkage literal loop map mod nand new next nor not null of on open or others out package
        port postponed procedure process pure range record register reject rem report return rol ror
        select severity shared signal sla sll sra srl subtype then to transport type unaffected
        units until use variable wait when while with xnor xor
    """,
)
VERILOG: Final = Language(
    name="Verilog-2001",
    listed="""
        always and assign automatic begin buf bufif0 bufif1 case casex casez cell cmos config
        deassign default defparam design disable edge else end endcase endconfig endfunction
        endgenerate endmodule endprimitive endspecify endtable endtask event for force forever fork
        function generate genvar highz0 highz1 if ifnone incdir include initial inout input instance
        integer join large liblist library localparam macromodule medium module nand negedge nmos
        nor noshowcancelled not notif0 notif1 or output parameter pmos posedge primitive pull0 pull1
        pulldown pullup pulsestyle_ondetect pulsestyle_onevent rcmos real realtime reg release
        repeat rnmos rpmos rtran rtranif0 rtranif1 scalared showcancelled signed small specify
        specparam strong0 strong1 supply0 supply1 table task time tran tranif0 tranif1 tri tri0 tri1
        triand trior trireg unsigned use vectored wait wand weak0 weak1 while wire wor xnor xor
    """,
)
SYSTEMVERILOG: Final = Language(
    name="SystemVerilog",
    listed="""
        accept_on alias always_comb always_ff always_latch assert assume before bind bins binsof bit
        break byte chandle checker class clocking const constraint context continue cover covergroup
        coverpoint cross dist do endchecker endclass endclocking endgroup endinterface endpackage
        endprogram endproperty endsequence enum eventually expect export extends extern final
        first_match foreach forkjoin global iff ignore_bins illegal_bins implements implies import
        inside int interconnect interface intersect join_any join_none let local logic longint
        matches modport nettype new nexttime null package packed priority program property protected
        pure rand randc randcase randsequence ref reject_on restrict return s_always s_eventually
        s_nexttime s_until s_until_with sequence shortint shortreal soft solve static string strong
        struct super sync_accept_on sync_reject_on tagged this throughout timeprecision timeunit
        type typedef unique unique0 union until until_with untyped uwire var virtual void wait_order
        weak wildcard with within
    """,
)
C: Final = Language(
    name="C99",
    listed="""
        auto break case char const continue default do double else enum extern float for goto if
        inline int long register restrict return short signed sizeof static struct switch typedef
        union unsigned void volatile while
    """,
)
SYSTEMRDL: Final = Language(
    name="SystemRDL 2.0",
    listed="""
        abstract accesstype addressingtype addrmap alias all alternate bit boolean bothedge byte
        component componentwidth constraint default encode enum external false field hw inside int
        internal level longint mem na name negedge nonsticky number onreadtype onwritetype posedge
        precedencetype property r rclr real ref reg regfile rset ruser rw rw1 shortint shortreal
        signal signed string struct sw this true type unsigned w w1 wclr with within woclr woset wot
        wr wset wuser wzc wzs wzt
    """,
)
LANGUAGES: Final = (VHDL, VERILOG, SYSTEMVERILOG, C, SYSTEMRDL)


def require_identifier(what: str, name: str, *, languages: tuple[Language, ...] = LANGUAGES) -> str:
    """Return a name that every generated language takes.

    Parameters
    ----------
    what
        What is called so, for the message.
    name
        The name. Case does not tell two words apart in VHDL, so it does not here.
    languages
        Those in which it will stand.

    Raises
    ------
    RenderError
        If it is no identifier, is too long, or is a reserved word; the message names the language.
    """
    if not SHAPE.fullmatch(name):
        raise RenderError(
            f"{what} = {name!r} is no identifier; it must be letters, digits and single "
            "underscores between them, a letter first"
        )
    if len(name) > LONGEST:
        raise RenderError(f"{what} = {name!r} has {len(name)} characters; the limit is {LONGEST}")
    taken = [language.name for language in languages if name.lower() in language.words]
    if taken:
        raise RenderError(f"{what} = {name!r} is a reserved word of {' and '.join(taken)}")
    return name
