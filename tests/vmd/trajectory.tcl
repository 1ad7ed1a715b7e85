# trajectory.tcl: AdK's closed-to-open trajectory row by row: as single comparisons, resumed, cancelled, with maps of all kinds.
source [file join $env(ESPDIFF_TESTS) support.tcl]
package require espdiff

proc read_rows {path} {
    set channel [open $path]
    set lines [split [string trim [read $channel]] \n]
    close $channel
    set rows {}
    # Without the checksum, which covers the head too: the head names each front end's files.
    foreach line $lines { if {![string match "#*" $line]} { lappend rows [regsub {,[0-9a-f]{1,16}$} $line ""] } }
    return [lrange $rows 1 end]
}

proc read_bytes {path} {
    set channel [open $path rb]
    set bytes [read $channel]
    close $channel
    return $bytes
}

set mol [mol new [input traj_adk/adk.psf] type psf waitfor all]
mol addfile [input traj_adk/adk_dims.dcd] type dcd waitfor all $mol

test "one row a frame, and the first is what compare says" {
    set result [espdiff trajectory -mol $mol -map none -frames 1:1:4 -reference {frame 0} -csv $scratch/a.csv -grid-spacing 1.5]
    check_equal rows [dict get $result rows] 4
    check_equal "rows in the file" [llength [read_rows $scratch/a.csv]] 4
    set single [espdiff compare [list mol $mol frame 0 map none] [list mol $mol frame 1 map none] -grid-spacing 1.5]
    set row [split [lindex [read_rows $scratch/a.csv] 0] ,]
    check_close rmsd [lindex $row 2] [espdiff result $single rmsd_A] 1e-6
    check_equal "second start" [regexp {,source,} [lindex [read_rows $scratch/a.csv] 1]] 1
    espdiff trajectory -mol $mol -map none -frames 1:1:2 -reference {frame 0} -csv $scratch/deform.csv -grid-spacing 1.5 \
        -method deform -max-iterations 3000
    check_equal "second start of deform" [regexp {,previous,} [lindex [read_rows $scratch/deform.csv] 1]] 1
    espdiff delete all
}

test "trajectory against trajectory, with the residues of each frame" {
    set other [mol new [input traj_adk/adk.psf] type psf waitfor all]
    mol addfile [input traj_adk/adk_dims.dcd] type dcd first 10 last 14 waitfor all $other
    # Frame i of the other molecule is frame i + 10 of the first.
    set options [list -map none -frames 0:1:2 -reference [list mol $other frame same] -grid-spacing 1.5]
    espdiff trajectory -mol $mol {*}$options -csv $scratch/same.csv -residues $scratch/residues.csv
    set single [espdiff compare [list mol $other frame 2 map none] [list mol $mol frame 2 map none] -grid-spacing 1.5]
    set row [split [lindex [read_rows $scratch/same.csv] 2] ,]
    check_equal "frame and source" [lrange $row 0 1] {2 2}
    check_close rmsd [lindex $row 2] [espdiff result $single rmsd_A] 1e-9
    set table [::espdiff::core::read_csv $scratch/residues.csv]
    set residues [espdiff residues $single]
    check_equal "columns" [llength [dict get $table columns]] [expr {[llength $residues] + 1}]
    foreach column [lrange [dict get $table columns] 1 end] residue $residues {
        set value [dict get [lindex [dict get $table rows] 2] $column]
        if {$value ne ""} { check_close $column $value [dict get $residue mean_displacement_A] 1e-6 }
    }
    check_refused {espdiff trajectory -mol $mol {*}[lreplace $options 3 3 0:1:5] -csv $scratch/no.csv} {ESPDIFF INPUT} \
        "has no frame 5; it has 5, from 0"
    check "nothing is written" {![file exists $scratch/no.csv]}
    # Deleted between two rows.
    proc delete_other {frame row} { global other; if {$frame == 0} { mol delete $other } }
    check_refused {espdiff trajectory -mol $mol {*}$options -csv $scratch/gone.csv -callback delete_other} {ESPDIFF INPUT} \
        "was deleted during the run"
    check_equal "rows until then" [llength [read_rows $scratch/gone.csv]] 1
    espdiff delete all
}

foreach start {source previous} {
    test "resumed after an interruption, each from $start: the same rows" {
        file delete $scratch/whole.csv $scratch/parts.csv
        set all [list -mol $mol -frames 41:1:46 -csv $scratch/whole.csv -grid-spacing 1.5 -start $start -map none]
        espdiff trajectory {*}$all
        set parts [lreplace $all 5 5 $scratch/parts.csv]
        proc stop_after {frame row} { if {$frame == 43} { return -code break } }
        check_refused {espdiff trajectory {*}$parts -callback stop_after} {ESPDIFF CANCELLED} cancelled
        check "some rows" {[llength [read_rows $scratch/parts.csv]] == 3}
        # A row that was being written when the machine went down.
        set channel [open $scratch/parts.csv a]
        puts -nonewline $channel "44,0,1.2"
        close $channel
        espdiff trajectory {*}$parts -resume 1
        check "the same bytes" {[read_bytes $scratch/parts.csv] eq [read_bytes $scratch/whole.csv]}
        check "starts" {[regexp ",previous," [read_rows $scratch/whole.csv]] == ($start eq "previous")}
        check "no state is left" {[llength [glob -nocomplain $scratch/parts.csv?*]] == 0}
        check_refused {espdiff trajectory {*}$parts} {ESPDIFF IO} "-resume" "-overwrite"
        check_refused {espdiff trajectory {*}$parts -resume 1 -isovalue 0.6} {ESPDIFF INPUT} "isovalue"
    }
}

# Models whose coordinates are the same numbers in single and in double precision: VMD keeps the former.
proc write_exact_models {path n} {
    set channel [open $path w]
    for {set model 0} {$model < $n} {incr model} {
        puts $channel [format "MODEL     %4d" [expr {$model + 1}]]
        for {set i 0} {$i < 24} {incr i} {
            set bend [expr {0.125 * ($i * $i * $model / 48)}]
            puts $channel [format "ATOM  %5d  %-3s ALA A%4d    %8.3f%8.3f%8.3f  1.00  0.00           %s" [expr {$i + 1}] \
                [lindex {N CA C O} [expr {$i % 4}]] [expr {$i / 4 + 1}] [expr {1.25 * $i}] \
                [expr {0.875 * ($i % 2) + $bend}] [expr {0.375 * ($i % 3)}] [lindex {N C C O} [expr {$i % 4}]]]
        }
        puts $channel ENDMDL
    }
    puts $channel END
    close $channel
}

# Beside a trajectory in memory VMD may be too large to be forked by `exec`.
proc command_line {args} {
    set process [::espdiff::core::start_program [list $::env(ESPDIFF) {*}$args] $::scratch/line.log]
    while {[set status [::espdiff::core::program_state $process]] eq "running"} { after 20 }
    check_equal "status of $args" $status 0
}

test "a file's models: the same bytes from the command line, from the file here, the same rows from its molecule" {
    set models $scratch/models.pdb
    write_exact_models $models 5
    foreach {arguments there} {
        {-frames all} {}
        {-frames 0:2:end -start previous} {--frames 0:2:4 --start previous}
        {-frames now,2,-1 -method deform} {--frames 0,2,4 --method deform}
    } {
        command_line trajectory $models $models --device cpu {*}$there -q -o $scratch/line.csv --overwrite
        set m [mol new $models type pdb waitfor all]
        animate goto 0
        espdiff trajectory -mol $m -radii element -reference [list file $models] {*}$arguments \
            -csv $scratch/molecule.csv -overwrite 1
        mol delete $m
        check "the same rows: $arguments" {[read_rows $scratch/molecule.csv] eq [read_rows $scratch/line.csv]}
        check "rows: $arguments" {[llength [read_rows $scratch/line.csv]] >= 3}
        if {[string match *now* $arguments]} continue
        espdiff trajectory -file $models -reference [list file $models] {*}$arguments -csv $scratch/models.csv -overwrite 1
        check "the same bytes: $arguments" {[read_bytes $scratch/models.csv] eq [read_bytes $scratch/line.csv]}
    }
}

test "computed potentials: the same bytes from the command line and from here, also in a periodic cell" {
    set channel [open [input pqr_pdb2pqr/1AJJ_pH7_AMBER.pqr]]
    set atoms [regexp -all -inline -line {^ATOM.*$} [read $channel]]
    close $channel
    # Water, so that the cell is taken.
    for {set i 0} {$i < 3} {incr i} {
        foreach {name charge radius dx} {OW -0.834 1.77 0 HW1 0.417 0.6 0.76 HW2 0.417 0.6 -0.76} {
            lappend atoms [format "ATOM  %5d %-4s HOH   %3d    %8.3f%8.3f%8.3f %7.4f %6.4f" [expr {[llength $atoms] + 1}] \
                $name [expr {900 + $i}] [expr {4 * $i + $dx}] -30.0 [expr {$dx ? 0.59 : 0}] $charge $radius]
        }
    }
    set file $scratch/wet.pqr
    set channel [open $file w]
    puts $channel "CRYST1   60.000   60.000   60.000  90.00  90.00  90.00 P 1           1"
    puts $channel [join $atoms \n]
    close $channel
    foreach {map there} {
        auto {}
        pme {--potential pme}
        {pme ewaldfactor 0.3} {--potential pme --ewaldfactor 0.3 --pme-cell own}
        {pb spacing 1.5} {--potential pb --pb-spacing 1.5}
    } {
        command_line trajectory $file $file --device cpu --grid-spacing 2 {*}$there -q -o $scratch/line.csv --overwrite
        espdiff trajectory -file $file -reference [list file $file] -map $map -grid-spacing 2 -csv $scratch/here.csv \
            -overwrite 1
        check_equal "the same bytes: $map" [read_bytes $scratch/here.csv] [read_bytes $scratch/line.csv]
    }
}

test "frames that are deleted during a run in the background: our words, told once" {
    set ::background {}
    proc background_error {message options} { lappend ::background $message }
    interp bgerror {} background_error
    set m [mol new [input nmr/1l2y.pdb] type pdb waitfor all]
    proc delete_frames {frame row} { if {$frame == 1} { animate delete beg 2 end -1 $::m } }
    set h [espdiff trajectory -mol $m -radii element -csv $scratch/deleted.csv -grid-spacing 2 -command list \
        -callback delete_frames]
    check_refused {espdiff wait $h} {ESPDIFF INPUT} "frame 2" "is not there any more; 2 are left"
    set ::waited 0
    after 300 { set ::waited 1 }
    vwait ::waited
    check_equal "nothing reaches the background error handler" $::background {}
    espdiff delete $h
    # An error of the user's own that `wait` threw is not told again either.
    animate delete all $m
    mol addfile [input nmr/1l2y.pdb] type pdb waitfor all $m
    proc fails {frame row} { error "mine" {} {MY CODE} }
    set h [espdiff trajectory -mol $m -radii element -csv $scratch/mine.csv -grid-spacing 2 -command list -callback fails]
    check_refused {espdiff wait $h} {MY CODE} mine
    set ::waited 0
    after 300 { set ::waited 1 }
    vwait ::waited
    check_equal "nor of the user's" $::background {}
    espdiff delete $h
    mol delete $m
}

test "`map none` as `-map none`" {
    set single [espdiff compare [list mol $mol frame 0 map none] [list mol $mol frame 1 map none] -grid-spacing 2]
    check_equal "no potential" [espdiff result $single mean_abs_difference] {}
    espdiff delete $single
}

test "against the frame before" {
    espdiff trajectory -mol $mol -map none -frames 0:2:6 -reference previous -csv $scratch/before.csv -grid-spacing 1.5
    set references {}
    foreach row [read_rows $scratch/before.csv] { lappend references [lindex [split $row ,] 1] }
    check_equal references $references {0 2 4}
}

test "a map for each frame: one for all, loaded ones, files, a command" {
    # Made potentials: any will do, the two frames' differ by a constant that the result must show.
    proc write_map {path value} {
        set channel [open $path w]
        puts $channel "# POTENTIAL (kT/e)\nobject 1 class gridpositions counts 4 4 4\norigin -100 -100 -100"
        puts $channel "delta 70 0 0\ndelta 0 70 0\ndelta 0 0 70\nobject 2 class gridconnections counts 4 4 4"
        puts $channel "object 3 class array type double rank 0 items 64 data follows"
        for {set i 0} {$i < 64} {incr i} { puts $channel $value }
        puts $channel "object \"potential\" class field"
        close $channel
    }
    foreach {frame value} {0 1 2 3 4 5} {
        write_map $scratch/map[format %02d $frame].dx $value
        mol addfile $scratch/map[format %02d $frame].dx type dx waitfor all $mol
    }
    proc map_of {mol frame} { list file $::scratch/map[format %02d $frame].dx }
    set options [list -mol $mol -frames 0:2:4 -grid-spacing 2 -overwrite 1 -csv $scratch/maps.csv]
    foreach {map expected} [list 0 {0.0 0.0 0.0} {volumes 0} {0.0 2.0 4.0} \
            [list files $scratch/map%02d.dx] {0.0 2.0 4.0} {command map_of} {0.0 2.0 4.0}] {
        espdiff trajectory {*}$options -map $map
        set found {}
        foreach row [read_rows $scratch/maps.csv] { lappend found [format %.1f [lindex [split $row ,] 6]] }
        check_equal "-map $map" $found $expected
    }
    check_refused {espdiff trajectory {*}$options -map 7} {ESPDIFF INPUT} "7"
    check_refused {espdiff trajectory {*}$options -map {files nowhere%d.dx}} {ESPDIFF IO} "nowhere0.dx"
    check_refused {espdiff trajectory {*}$options -frames 0:1:500} {ESPDIFF INPUT} "0 to 97"
    check_equal "nothing is left" [list [espdiff handles] [::espdiff::core::handles] [::espdiff::core::volumes]] {{} {} {}}
}

test "a frame that fails stops the run, or is skipped with its error" {
    set options [list -mol $mol -frames 0:2:6 -grid-spacing 2 -overwrite 1 -csv $scratch/skip.csv \
        -map [list files $scratch/map%02d.dx]]
    check_refused {espdiff trajectory {*}$options} {ESPDIFF IO} "map06.dx"
    set result [espdiff trajectory {*}$options -on-error skip]
    check_equal skipped [dict get $result skipped] 1
    check "the error is in the row" {[string match "*map06.dx*" [lindex [read_rows $scratch/skip.csv] end]]}
}

test "38 models of 1L2Y, as in tclsh from the file" {
    set peptide [mol new [input nmr/1l2y.pdb] type pdb waitfor all]
    check_equal "models" [molinfo $peptide get numframes] 38
    set result [espdiff trajectory -mol $peptide -radii element -csv $scratch/1l2y.csv]
    check_equal rows [dict get $result rows] 38
    espdiff trajectory -file [input nmr/1l2y.pdb] -csv $scratch/file.csv
    foreach row [read_rows $scratch/1l2y.csv] other [read_rows $scratch/file.csv] {
        set from_vmd [lindex [split $row ,] 2]
        set from_file [lindex [split $other ,] 2]
        check "RMSD of $row" {abs($from_vmd - $from_file) < 1e-5}
    }
}

test "explicit water: the mean over frames has a small part of the differences of single frames" {
    set box [mol new [input box_tz2/tz2.truncoct.parm7] type parm7 waitfor all]
    mol addfile [input box_tz2/tz2.truncoct_from_nc.dcd] type dcd waitfor all $box
    set run [list -mol $box -sel {not water and not ion} -frames 3,6 -grid-spacing 1.5 -csv $scratch/water.csv -overwrite 1]
    foreach {name map} {single pme mean {pme average 8}} {
        espdiff trajectory {*}$run -map $map
        set rows [dict get [::espdiff::core::read_csv $scratch/water.csv] rows]
        set difference($name) [dict get [lindex $rows 1] mean_abs_difference]
        set warnings($name) [dict get [lindex $rows 1] warnings]
        set trusted($name) [dict get [lindex $rows 1] trustworthy]
        check_equal "$name: nothing outside its map" [expr {[dict get [lindex $rows 1] outside_maps] < 0.001}] 1
    }
    note "    mean |difference|: $difference(single) with single frames, $difference(mean) with means over 8"
    check "a tenth at most" {$difference(mean) < 0.1 * $difference(single)}
    check "warned" {[string match "*single frames with explicit water*" $warnings(single)]}
    check_equal "never trustworthy" $trusted(single) 0
    check "not warned" {![string match "*single frames with explicit water*" $warnings(mean)]}
    # A part that was asked for is taken.
    espdiff trajectory {*}$run -map {pme average 2 part smooth}
    check "the head says it" {[string match "*average 2*" [read_bytes $scratch/water.csv]]}
    check_equal "a window at the end" [::espdiff::window_around 9 4 10] {9 6 7 8}
    check_equal "in the middle" [::espdiff::window_around 5 4 10] {5 4 6 7}
    check_refused {espdiff trajectory {*}$run -map {pme average 11}} {ESPDIFF INPUT} "average over 11 frames" "has 10"
    check_refused {espdiff trajectory {*}$run -map {pb average 2}} {ESPDIFF INPUT} "nothing to average"
    check_refused {espdiff trajectory {*}$run -map {pme average some}} {ESPDIFF INPUT} "average 'some'"
    check_refused {espdiff trajectory -file [input nmr/1l2y.pdb] -map {pme average 2} -csv $scratch/x.csv} {ESPDIFF INPUT} \
        "needs -mol"
    mol delete $box
}

finish
