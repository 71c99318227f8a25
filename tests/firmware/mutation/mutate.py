#!/usr/bin/env python3
"""Takes one rule of the driver away, and sees tests/firmware/driver fail.

  mutate.py --list          the names of the mutations
  mutate.py --prepare       compiles in advance what no mutation changes
  mutate.py NAME            compiles the tests against the driver without that rule, and runs them

Exit status 0 when exactly the tests that the mutation names noticed (and perhaps others of their file),
1 when one of them did not, 2 when the mutation does not fit the driver any more.
In the environment: SOURCE, WORK (a folder in which each mutation has one of its own), CXX, LAUNCHER (may
be empty), SIM (the simulator's libraries).
"""

import os
import pathlib
import re
import shlex
import subprocess
import sys

# All that the tests include but for the driver. Not optimised: a mutation is compiled for a few runs.
PRECOMPILED = """\
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <ostream>
#include <random>
#include <roio/frame_length.hpp>
#include <string>
#include <utility>
#include <vector>

#include "sanitizers.hpp"
#include "seed.hpp"
"""
FLAGS = ["-std=c++20", "-O0"]
RECEIVE = "receive_order_test.cpp"
TRANSMIT = "transmit_order_test.cpp"
OTHER = "receive_test.cpp"
BEGIN = "begin_test.cpp"
LINE = "interrupt_line_test.cpp"
MODE = "mode_test.cpp"
GUARD = 240  # seconds; a driver without its rules may hang

# name: (what the driver no longer does, text of one of its headers, what stands there instead,
#        test file, tests that must fail)
MUTATIONS = {
    "rxb1_is_older_when_rxb0_was_freed_beside_it": (
        "remember that RXB1, full when RXB0 was freed, has the older frame",
        "    if (first) {\n      status_ |= QuickStatus::rx1;",
        "    if (false) {\n      status_ |= QuickStatus::rx1;",
        RECEIVE, ["ReceiveOrder.AFrameRollsOverWhileRxb0IsRead",
                  "ReceiveOrder.EveryInterleavingWhilePolling",
                  "ReceiveOrder.EveryInterleavingWithAnInterruptLine"]),
    "rxb0_is_older_when_rxb1_was_freed": (
        "forget that RXB1 was older once it has been read",
        "    if (first) {\n      status_ |= QuickStatus::rx1;",
        "    if (true) {\n      status_ |= QuickStatus::rx1;",
        RECEIVE, ["ReceiveOrder.EveryInterleavingWhilePolling",
                  "ReceiveOrder.EveryInterleavingWithAQueue"]),
    "rxb0_first_when_both_were_found_full": (
        "read RXB0 before RXB1 when both were filled unseen",
        "read_rx_buffer((status_ & QuickStatus::rx0) != 0, frame)",
        "read_rx_buffer((status_ & QuickStatus::rx1) == 0, frame)",
        RECEIVE, ["ReceiveOrder.ReadsRxb0FirstWhenBothWereFilledUnseen",
                  "ReceiveOrder.EveryInterleavingWhilePolling"]),
    "older_rxb1_before_rxb0": (
        "read RXB1 first when it is the older one",
        "    quick &= static_cast<uint8_t>(~QuickStatus::rx0);  // newer",
        "    // newer",
        RECEIVE, ["ReceiveOrder.AFrameRollsOverWhileRxb0IsRead",
                  "ReceiveOrder.EveryInterleavingWithAQueue"]),
    "look_right_after": (
        "look at the status right after a buffer was freed, with nothing in between",
        "    transaction.release();\n    looks =",
        "    for (int i = 0; i < 30; ++i) {\n      transaction.release();\n"
        "      transaction.restart(static_cast<uint8_t>(Instruction::read_status));\n    }\n"
        "    transaction.release();\n    looks =",
        RECEIVE, ["ReceiveOrder.EveryInterleavingWhilePolling"]),
    "a_line_that_is_low_is_no_frame_yet": (
        "read the status before it believes the interrupt line",
        "    look();\n    return true;",
        "    if (Port::has_interrupt_line) {\n      status_ |= QuickStatus::rx0;\n    } else {\n      look();\n    }\n"
        "    return true;",
        RECEIVE, ["ReceiveOrder.AnInterruptLineThatIsStuckLowIsNoFrame"]),
    "a_line_that_rises_early_tells_of_a_lost_chip": (
        "look at the interrupt line before it trusts what it read",
        "    called = polls || port().interrupt_line_is_low();",
        "    called = true;",
        OTHER, ["ChipLoss.AFrameReadFromAChipThatWasResetIsDiscarded"]),
    "a_line_that_is_off_throws_no_frame_away": (
        "hand out a frame of a chip that answers, whatever the interrupt line says",
        "    if (take_in(quick) != 0) {\n      lose_chip();\n      count(counters_.discarded);",
        "    if (take_in(quick) != 0 || !called) {\n      lose_chip();\n      count(counters_.discarded);",
        LINE, ["InterruptLineOff.FromSomeTimeOn/NotConnected",
               "InterruptLine.ComesOffWhileAFrameIsRead", "InterruptLine.ThatIsLooseLosesNothing"]),
    "a_line_that_is_off_is_left_alone": (
        "poll once it has found the interrupt line off",
        "  line().set_on(false);",
        "",
        LINE, ["InterruptLineOff.FromSomeTimeOn/NotConnected", "InterruptLine.ThatIsLooseLosesNothing"]),
    "a_lost_chip_is_no_line_that_is_off": (
        "look whether it is the chip before it blames the interrupt line",
        "    if (take_in(quick) != 0) {\n      lose_chip();",
        "    if (take_in(quick) != 0) {\n      lose_chip();\n      if (!called) {\n        lose_line();\n      }",
        LINE, ["InterruptLine.IsNotBlamedForALostChip"]),
    "the_line_is_tried_at_the_beginning": (
        "see the interrupt line follow the chip in begin()",
        "    line().set_on(falls && rises);",
        "    line().set_on(true);",
        LINE, ["InterruptLineOff.FromTheBeginning/NotConnected",
               "InterruptLineOff.FromTheBeginning/StuckLow"]),
    "the_line_is_let_go_of": (
        "clear the flag by which it tried the interrupt line",
        "    const bool rises = line_follows(false);  // in any case: no flag may stay",
        "    const bool rises = falls && line_follows(false);",
        LINE, ["InterruptLineOff.FromTheBeginning/NotConnected"]),
    "an_idle_look_that_went_wrong_is_repeated": (
        "look again when an idle look was nonsense",
        "  if (nonsense != 0 && look_once() != 0) {",
        "  if (nonsense != 0) {",
        RECEIVE, ["ReceiveOrder.ASpikeInAnIdleLookIsForgiven"]),
    "the_look_after_a_read_is_not_repeated": (
        "take the look right after a read for the only one",
        "    if (take_in(quick) != 0) {\n      lose_chip();",
        "    if (take_in(quick) != 0 && look_once() != 0) {\n      lose_chip();",
        RECEIVE, ["ReceiveOrder.IsNotGuessedAfterALookThatWentWrong"]),
    "all_ones_want_a_second_opinion": (
        "tell a line stuck at 1 from a chip that is busy with everything",
        "  return quick >= QuickStatus::all_in_use ? mode_differs_from(control_) : 0;",
        "  return 0;",
        OTHER, ["ChipLoss.ALineStuckHighIsNotTakenForAllBuffersInUse"]),
    "nothing_is_cleared_that_was_not_read": (
        "leave the chip's receive flags alone",
        "      check_soon();\n    }\n  }\n  return true;",
        "      check_soon();\n    }\n  }\n  modify_register(Register::canintf, first ? 1 : 2, 0);\n"
        "  return true;",
        RECEIVE, ["ReceiveOrder.EveryInterleavingWhilePolling"]),
    "the_second_frame_goes_behind_the_first": (
        "send a second frame from the buffer behind the first",
        "first_buffer) ? second_buffer : first_buffer;",
        "first_buffer) ? urgent_buffer : first_buffer;",
        TRANSMIT, ["TransmitOrderOf/TwoPlaces.ManyInARow"]),
    "a_buffer_for_urgent_frames": (
        "keep buffer 2 for urgent frames",
        "      return no_buffer;\n    }\n    return is_pending(pending, first",
        "      return is_pending(pending, urgent_buffer) ? no_buffer : urgent_buffer;\n    }\n"
        "    return is_pending(pending, first",
        TRANSMIT, ["TransmitOrderOf/TwoPlaces.ManyInARow"]),
    "urgent_frames_enter_the_queue_ahead": (
        "queue an urgent frame ahead of the normal ones",
        "  if (is_urgent(frame)) {\n    while (place > 0) {",
        "  if (false) {\n    while (place > 0) {",
        TRANSMIT, ["TransmitOrderOf/TwoPlaces.UrgentFramesKeepTheirOrderAmongThemselves"]),
    "urgent_frames_keep_their_order_in_the_queue": (
        "queue an urgent frame behind the urgent ones",
        "      if (is_urgent(tx_queue()[ahead].frame)) {\n        break;\n      }\n",
        "",
        TRANSMIT, ["TransmitOrderOf/TwoPlaces.UrgentFramesKeepTheirOrderAmongThemselves"]),
    "a_frame_waits_behind_the_queue": (
        "let a frame wait while others of its priority are in the queue",
        "tx_queue().empty() || (is_urgent(frame) && !is_urgent(tx_queue().front().frame));",
        "true;",
        TRANSMIT, ["All/TransmitTrouble.EachFrameIsSentOnceAndReportedTruly/none"]),
    "a_pending_buffer_is_left_alone": (
        "leave a buffer alone that the chip is still to send",
        "    if (is_pending(pending, second_buffer)) {",
        "  if (false) {",
        TRANSMIT, ["TransmitOrderOf/TwoPlaces.ManyInARow"]),
    "a_place_once_passed_is_not_taken_again": (
        "back to back, wait for both buffers after the last place",
        "place_ == places || is_pending(pending, buffer)",
        "is_pending(pending, buffer)",
        TRANSMIT, ["TransmitOrderOf/SixPlaces.ManyInARow"]),
    "each_pair_behind_the_pair_before": (
        "back to back, send each pair with a lower priority",
        "static_cast<uint8_t>(top - (place_ >> 1));",
        "top;",
        TRANSMIT, ["All/BackToBackTrouble.EachFrameIsSentOnceAndReportedTruly/contention"]),
    "what_became_of_it_is_read": (
        "read what became of a frame when it was taken back",
        "  return requests().aborting() || (control_ & mcp2515::Control::one_shot) != 0;",
        "  return false;",
        TRANSMIT, ["Abort.TakesBackWhatHasNotBegun",
                   "All/TransmitTrouble.EachFrameIsSentOnceAndReportedTruly/aborts"]),
    "a_dlc_above_8_is_8_bytes": (
        "take a DLC of 9 to 15 as 8",
        "    frame.limit_length();",
        "",
        OTHER, ["Receive.ADlcAboveEightIsEightBytesAndNoMore"]),
    "foreign_frames_are_dropped": (
        "drop remote and standard frames",
        "Traits::all_kinds || Traits::wants(frame);",
        "true;",
        OTHER, ["Receive.RemoteAndStandardFramesAreCountedAndDropped"]),
    "overflows_are_looked_for": (
        "look for an overflow after both buffers were full",
        "      check_soon();",
        "",
        OTHER, ["Overflow.EachLossThatIsServedInBetweenIsCounted"]),
    "overflow_flags_are_cleared": (
        "make the overflow flags ready for the next loss",
        "    write_register(Register::eflg, 0);  // no other bit can be written",
        "",
        OTHER, ["Overflow.IsToldHoweverTheChipFlagsIt"]),
    "the_state_of_the_bus_is_looked_at": (
        "look at the chip every so many calls",
        "calls_ >= mcp2515::calls_between_checks &&",
        "false &&",
        OTHER, ["BusState.IsToldWhilePolling", "ChipLoss.ASilentLineIsNotBelievedForEver"]),
    "a_reset_shows_in_the_status": (
        "expect its own flags in each status",
        "  return changed & (quick | QuickStatus::txif) & no_rx;",
        "  return changed & (quick | QuickStatus::txif) & no_rx & 0;",
        OTHER, ["ChipLoss.AResetIsNoticedWhilePolling",
                "ChipLoss.AFrameReadFromACableThatFellOffIsDiscarded"]),
    "what_was_written_is_read_back": (
        "read back what it wrote",
        "  return differences == 0;",
        "  return true;",
        BEGIN, ["Begin.NoticesAWriteThatDidNotArrive"]),
    "the_oscillator_is_waited_for": (
        "wait for a chip that starts slowly",
        "  uint8_t left = mcp2515::pauses;\n  while (!enters(control)",
        "  uint8_t left = 1;\n  while (!enters(control)",
        BEGIN, ["Begin.WaitsForAChipThatStartsSlowly"]),
    "the_mode_is_confirmed": (
        "see the chip enter its mode",
        "  return mode_differs_from(control) == 0;",
        "  return true;",
        BEGIN, ["Begin.OnABusThatIsNeverIdleSaysSoInTime"]),
    "what_rested_is_asked_what_it_knows": (
        "see whether a chip that rested still knows what it was told",
        "  if (running()) {\n    look();\n  }\n  if (!running()) {\n    control_ = 0;",
        "  if (!running()) {\n    control_ = 0;",
        MODE, ["Rest.WithoutPowerTheChipForgetsAndThatIsTold/InConfigurationMode"]),
    "it_rests_when_all_is_sent": (
        "send all before the chip rests",
        "(requested() != 0 || !tx_queue().empty())",
        "false",
        MODE, ["Rest.ComesWhenAllIsSent/Asleep", "Rest.ComesWhenAllIsSent/InConfigurationMode"]),
    "the_bus_may_wake_it": (
        "let the bus wake a chip that sleeps",
        "  modify_register(Register::caninte, Interrupt::wake_up, Interrupt::wake_up);",
        "",
        MODE, ["Sleep.EndsByTheBusWithTheFrameThatWakesItLost"]),
    "a_sleep_that_is_over_was_one": (
        "know that the bus may wake the chip before anybody looks",
        "slept = is_asleep() || (read_register(Register::canintf) & mcp2515::Interrupt::wake_up) != 0;",
        "slept = is_asleep();",
        MODE, ["Sleep.OnABusyBusIsShortAndOkAllTheSame"]),
    "what_woke_listens": (
        "expect a chip that woke to listen only",
        "  control_ = mcp2515::Control::with_mode(control_, mcp2515::Mode::listen_only);",
        "",
        MODE, ["Sleep.OnABusThatIsStuckEndsWithAWord"]),
}


def fail(status, text):
    print(f"mutate: {text}", file=sys.stderr)
    sys.exit(status)


def write_mutated_headers(source, work, old, new):
    headers = source / "firmware/mcp2515/include/roio"
    mutated = work / "include/roio"
    mutated.mkdir(parents=True, exist_ok=True)
    found = 0
    for header in headers.glob("*.hpp"):
        text = header.read_text()
        found += text.count(old)
        (mutated / header.name).write_text(text.replace(old, new))
    if found != 1:
        fail(2, f"expected once in {headers}, found {found} times:\n{old}")


def compile_with_launcher(*arguments):
    launcher = shlex.split(os.environ.get("LAUNCHER", ""))
    # What ccache wants to be told before it looks at something precompiled.
    environment = dict(os.environ, CCACHE_SLOPPINESS="pch_defines,time_macros")
    subprocess.run([*launcher, os.environ["CXX"], *FLAGS, *arguments], check=True, env=environment)


def includes(source):
    return [f"-I{source / folder}" for folder in (
        "libroio/core/include", "sim/include", "tests/support", "tests/firmware/driver")]


def prepare(source, work):
    work.mkdir(parents=True, exist_ok=True)
    header = work / "precompiled.hpp"
    header.write_text(PRECOMPILED)
    compile_with_launcher(*includes(source), "-x", "c++-header", header, "-o", f"{header}.gch")


def compile_tests(source, work, folder, test_file):
    program = folder / "mutated_test"
    compiled = folder / "mutated_test.o"
    compile_with_launcher("-include", work / "precompiled.hpp", f"-I{folder / 'include'}", *includes(source),
                          "-c", source / "tests/firmware/driver" / test_file, "-o", compiled)
    subprocess.run([os.environ["CXX"], compiled, *os.environ["SIM"].split(":"), "-lgtest", "-lgtest_main",
                    "-lpthread", "-o", program], check=True)
    return program


def failing_tests(program, tests):
    """Runs the tests that have to fail, each by itself: a mutated driver may hang or crash."""
    failed = []
    for test in tests:
        try:
            done = subprocess.run([program, f"--gtest_filter={test}"], capture_output=True, text=True,
                                  timeout=GUARD)
        except subprocess.TimeoutExpired:
            failed.append(test)
            continue
        if not re.search(r"\[ +RUN +\] " + re.escape(test), done.stdout):
            fail(2, f"there is no test {test}")
        if done.returncode != 0:
            failed.append(test)
    return failed


def main():
    if sys.argv[1:] == ["--list"]:
        print(";".join(MUTATIONS), end="")
        return 0
    source, work = pathlib.Path(os.environ["SOURCE"]), pathlib.Path(os.environ["WORK"])
    if sys.argv[1:] == ["--prepare"]:
        prepare(source, work)
        return 0
    if len(sys.argv) != 2 or sys.argv[1] not in MUTATIONS:
        fail(2, "expected --list, --prepare or the name of a mutation")
    what, old, new, test_file, tests = MUTATIONS[sys.argv[1]]
    folder = work / sys.argv[1]
    write_mutated_headers(source, folder, old, new)
    program = compile_tests(source, work, folder, test_file)
    failed = failing_tests(program, tests)
    for test in tests:
        print(f"a driver that does not {what}: {test} {'fails' if test in failed else 'DOES NOT NOTICE'}")
    return 0 if failed == tests else 1


if __name__ == "__main__":
    sys.exit(main())
