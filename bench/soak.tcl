# soak.tcl: many comparisons in one Tcl interpreter: memory, descriptors, threads and temporary files before and after.
#   ESPDIFF_TCL_PACKAGE=build/vmd/tcl/espdiff0.1.0 tclsh bench/soak.tcl ?N? ?FOLDER?
lassign [concat $argv {1000 .}] n folder
if {[llength $argv] > 1} { set folder [lindex $argv 1] }
lappend auto_path $env(ESPDIFF_TCL_PACKAGE)
package require espdiff

proc holdings {} {
    set channel [open /proc/self/status]
    regexp {VmRSS:\s+(\d+)} [read $channel] all resident
    close $channel
    return [list $resident [llength [glob /proc/self/fd/*]] [llength [glob /proc/self/task/*]] \
        [llength [glob -nocomplain /tmp/espdiff-[pid]-*]]]
}

proc chain {path amount} {
    set channel [open $path w]
    for {set i 0} {$i < 24} {incr i} {
        set x [expr {1.6 * $i}]
        puts $channel [format "ATOM %d CA ALA %d %.3f %.3f %.3f %.2f 1.7" [expr {$i + 1}] [expr {$i + 1}] $x \
            [expr {$amount * 0.02 * $x * $x + 0.6 * ($i % 2)}] [expr {0.5 * ($i % 3)}] [expr {0.1 * ($i % 5 - 2)}]]
    }
    close $channel
}

set source [file join $folder soak-a.pqr]
set target [file join $folder soak-b.pqr]
chain $source 0
chain $target 0.3
puts "run  resident (kB)  descriptors  threads  temporary files"
for {set i 0} {$i <= $n} {incr i} {
    if {$i == $n / 10} { set warm [holdings] }
    if {$i % max(1, $n / 10) == 0} { puts "$i  [join [holdings] {  }]" }
    if {$i == $n} break
    set h [espdiff compare [list file $source] [list file $target] -grid-spacing 1.5 -threads 2 -device cpu]
    espdiff result $h
    espdiff delete $h
}
set end [holdings]
file delete $source $target
set growth [expr {100.0 * ([lindex $end 0] - [lindex $warm 0]) / [lindex $warm 0]}]
puts [format "growth after run %d: %.2f %% of memory" [expr {$n / 10}] $growth]
exit [expr {$growth < 1 && [lrange $warm 1 end] eq [lrange $end 1 end] ? 0 : 1}]
