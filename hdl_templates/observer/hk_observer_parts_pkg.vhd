-- Pieces of programs that the steps of the observer are made of.
use work.hk_observer_words_pkg.all;
use work.hk_sequence_pkg.all;

package hk_observer_parts_pkg is

  -- A part of a program that a design may lack; one several times over.
  function only_with (has : boolean; program : program_t) return program_t;
  function repeated (program : program_t; times : positive) return program_t;

  -- What the accumulator holds, at most the limit in size, goes into a word.
  function clamp (limit, into : word_t) return program_t;

  -- 1 goes into a word if a value is larger than a limit, in size.
  function note_beyond (value, limit, note : word_t) return program_t;

  -- The sum of three products is in the accumulator.
  function dot (a_1, b_1, a_2, b_2, a_3, b_3 : word_t) return program_t;

end package hk_observer_parts_pkg;

package body hk_observer_parts_pkg is

  constant nothing_c : program_t(1 to 0) := (others => take(zero));

  function only_with (has : boolean; program : program_t) return program_t is
  begin
    if has then
      return program;
    end if;
    return nothing_c;
  end function only_with;

  function repeated (program : program_t; times : positive) return program_t is
  begin
    if times = 1 then
      return program;
    end if;
    return program & repeated(program, times - 1);
  end function repeated;

  function clamp (limit, into : word_t) return program_t is
    constant program_c : program_t := (
      less(limit, mode => test),
      take(zero, mode => if_not),
      plus(limit),
      plus(limit, mode => test),
      take(zero, mode => if_negative),
      less(limit, into => into)
    );
  begin
    return program_c;
  end function clamp;

  function note_beyond (value, limit, note : word_t) return program_t is
    constant program_c : program_t := (
      take(limit),
      less(value, mode => test),
      take(unit, into => note, mode => if_negative),
      take(limit),
      plus(value, mode => test),
      take(unit, into => note, mode => if_negative)
    );
  begin
    return program_c;
  end function note_beyond;

  function dot (a_1, b_1, a_2, b_2, a_3, b_3 : word_t) return program_t is
    constant program_c : program_t := (
      take(a_1, b_1),
      plus(a_2, b_2),
      plus(a_3, b_3)
    );
  begin
    return program_c;
  end function dot;

end package body hk_observer_parts_pkg;
