# endings.tcl: a hundred comparisons leave the memory as it was; cancelling at random moments never hangs.
source [file join $env(ESPDIFF_TESTS) support.tcl]
package require espdiff

# Resident memory of this process, MB.
proc resident {} {
    set channel [open /proc/self/status]
    set text [read $channel]
    close $channel
    regexp {VmRSS:\s+([0-9]+)} $text -> kilobytes
    return [expr {$kilobytes / 1024.0}]
}

set mol [mol new [input ubq/ubq.pqr] type pqr waitfor all]
set other [mol new [input ubq/ubq.pqr] type pqr waitfor all]

test "100 comparisons: memory stays flat" {
    for {set i 0} {$i < 100} {incr i} {
        espdiff delete [espdiff compare [list mol $mol map none] [list mol $other map none] -grid-spacing 1.2]
        if {$i == 19} { set early [resident] }
    }
    set late [resident]
    note "    resident after 20: [format %.1f $early] MB, after 100: [format %.1f $late] MB"
    check "flat" {$late < $early + 8}
}

test "cancelled at 60 random moments: always an end, and the next comparison works" {
    expr {srand(7)}
    array set states {}
    for {set i 0} {$i < 60} {incr i} {
        set handle [espdiff compare [list mol $mol map none] [list mol $other map none] -command list]
        after [expr {int(rand() * 400)}]
        espdiff cancel $handle
        if {$i % 3 == 0} { espdiff delete $handle; continue }
        set begun [clock milliseconds]
        catch { espdiff wait $handle -timeout 5000 }
        set took [expr {[clock milliseconds] - $begun}]
        check "ended within 5 s" {$took < 5000}
        incr states([dict get [espdiff status $handle] state])
        espdiff delete $handle
    }
    note "    [array get states]"
    check_equal "the next one" [espdiff result [espdiff compare [list mol $mol map none] [list mol $other map none]] certificate converged] 1
    espdiff delete all
}

test "break from -progress cancels, and says so" {
    proc stop {stage fraction} { if {$stage eq "deform"} { return -code break } }
    check_refused {espdiff compare [list mol $mol map none] [list mol $other map none] -progress stop -method deform -min-displacement 0} \
        {ESPDIFF CANCELLED} "cancelled"
}

test "in the background VMD continues, and the command is called at the end" {
    set ::ticks 0
    proc tick {} { incr ::ticks; after 10 tick }
    tick
    espdiff compare [list mol $mol map none] [list mol $other map none] -grid-spacing 0.7 -command {set ::finished}
    vwait ::finished
    after cancel tick
    check "VMD served events meanwhile" {$::ticks > 10}
    check_equal "state" [dict get [espdiff status $::finished] state] done
    espdiff delete all
}

# VMD is left while this runs: run_in_vmd sees whether it ends.
espdiff compare [list mol $mol map none] [list mol $other map none] -grid-spacing 0.4 -method deform -min-displacement 0 -command list
after 300
finish
