# ensemble.tcl: ensembles of VMD's molecules: the numbers of files, drawings, patches, and molecules that go away.
source [file join $env(ESPDIFF_TESTS) support.tcl]
package require espdiff

set quick {-grid-spacing 1.6 -map coulomb}
source [file join $env(ESPDIFF_TESTS) ensemble_support.tcl]
# Before anything is loaded: VMD may reserve gigabytes for frames, and a process of that size may not fork.
set words {}
foreach state {wild mutant} {
    lappend words --group $state
    foreach number {1 2 3 4} { lappend words $folder/trpcage_${state}_$number.pdb.gz }
    lappend words --charges $state=$folder/trpcage_$state.pqr
}
exec $env(ESPDIFF) ensemble {*}$words --frames 0:20:99 -o $scratch/cli -q --grid-spacing 1.6 --potential coulomb 2>@1
set box [input box_tz2/tz2.truncoct.parm7]
set frames [input box_tz2/tz2.truncoct_from_nc.dcd]
# The program reads parm7 by VMD's plugins, which are files of their own in some VMDs and built into others.
catch { exec $env(ESPDIFF) ensemble --group tz2 $box $frames --frames 0:3:9 --template 0 --radii element -o $scratch/box -q \
    --grid-spacing 1.6 2>@1 } said
set has_plugins [file exists $scratch/box.h5]
if {!$has_plugins} { note "    SKIPPED: pme of files: $said" }
foreach state {wild mutant} {
    foreach number {1 2 3 4} { lappend runs($state) [list mol [load_run $state $number]] }
}
set groups [list wild $runs(wild) mutant $runs(mutant)]

test "molecules with frames: the difference that files give, at the mutant's residue" {
    check_equal frames [molinfo [lindex $runs(wild) 0 1] get numframes] 5
    set h [espdiff ensemble $groups -output $scratch/vmd {*}$quick]
    check_equal frames [espdiff result $h frames] 40
    set files [espdiff ensemble {} -from $scratch/cli.h5 -output $scratch/from]
    foreach keys {{area_A2} {test mean_abs_difference} {noise_floor replicates_across_groups}} {
        check_close $keys [espdiff result $h {*}$keys] [espdiff result $files {*}$keys] 1e-4
    }
    check_equal template [espdiff result $h plan template name] \
        [string map {trpcage_ ""} [espdiff result $files plan template name]]
    check "sign" {[espdiff result $h test mean_abs_difference] > 0}
}

if {$has_plugins} {
test "pme with the water of VMD's molecule, in the cell of each frame: as from the files" {
    set mol [mol new $box type parm7 waitfor all]
    mol addfile $frames type dcd first 0 last 9 step 3 waitfor all $mol
    set water [espdiff ensemble [list tz2 [list [list mol $mol radii element]]] -output $scratch/water -template 0 \
        -grid-spacing 1.6]
    set files [espdiff ensemble {} -from $scratch/box.h5 -output $scratch/box]
    check_equal potential [espdiff result $water plan potential] [espdiff result $files plan potential]
    check "pme" {[string match "pme*" [espdiff result $water plan potential]]}
    foreach key {mean_potential mean_rmsd_A} {
        check_close $key [dict get [lindex [espdiff result $water replicates] 0] $key] \
            [dict get [lindex [espdiff result $files replicates] 0] $key] 1e-3
    }
    check_close area [espdiff result $water area_A2] [espdiff result $files area_A2] 1e-4
    espdiff delete $water $files
    mol delete $mol
}
}

test "it is drawn: the difference, faded where it is not significant" {
    set molecules [espdiff draw $h]
    check "molecules" {[llength $molecules] >= 2}
    check_equal view [molinfo [lindex $molecules 0] get center_matrix] \
        [molinfo [lindex $runs(wild) 0 1] get center_matrix]
    check_equal title [::espdiff::ensemble_title $h difference] "Potential difference, mutant - wild"
    set n [llength [espdiff patches $h]]
    check_refused { espdiff draw $h -patch 99 } {ESPDIFF INPUT} "has $n patch"
    check_refused { espdiff draw $h -view linked } {ESPDIFF INPUT} "-view linked"
    check_refused { espdiff draw $h -color slip } {ESPDIFF INPUT} "is not difference, source, target or t"
    espdiff draw $h -color target -uncertain plain
    save_state $scratch/state.vmd
    set channel [open $scratch/state.vmd]
    set state [read $channel]
    close $channel
    check "saved" {[regexp {espdiff draw \[(espdiff ensemble \{\} -from \S+ -output \S+)\] [^\n]*-color target} $state whole again]}
    set from [eval $again]
    check_equal "the same answer" [espdiff result $from test] [espdiff result $h test]
    espdiff delete $from
    if {$n > 0} { espdiff draw $h -patch 1 }
    espdiff undraw $h
}

test "in the background, cancelled, and gone on with" {
    set ::stages {}
    proc stage {stage fraction} {
        lappend ::stages $stage
        # Progress is told a few times a second: a frame may be missed.
        if {[regexp {^frame (\d+) } $stage -> frame] && $frame >= 5} { return -code break }
    }
    set b [espdiff ensemble $groups -output $scratch/back {*}$quick -progress stage -command {set ::ended}]
    vwait ended
    check_equal state [dict get [espdiff status $b] state] cancelled
    espdiff delete $b
    set again [espdiff ensemble $groups -output $scratch/back {*}$quick -resume 1]
    check "resumed" {[espdiff result $again resumed] >= 4}
    set whole [open $scratch/vmd.h5 rb]
    set back [open $scratch/back.h5 rb]
    check "the same bytes" {[read $whole] eq [read $back]}
    close $whole
    close $back
    check_refused { espdiff ensemble $groups -output $scratch/back {*}$quick -resume 1 -frames 0:1:3 } {ESPDIFF INPUT} \
        "is of another run"
}

test "what molecules of VMD refuse" {
    check_refused { espdiff ensemble [list wild [list [list mol 99]]] -output $scratch/bad } {ESPDIFF INPUT} \
        "there is no molecule '99'"
    set one [lindex $runs(wild) 0 1]
    check_refused { espdiff ensemble [list wild [list [list mol $one] [list mol $one]]] -output $scratch/bad } \
        {ESPDIFF INPUT} "has the same content"
    check_refused { espdiff ensemble [list wild [list [list mol $one frames 2]]] -output $scratch/bad } \
        {ESPDIFF INPUT} "has 1 frame"
    check_refused { espdiff ensemble [list wild [list [list mol $one sel "resname NONE"]]] -output $scratch/bad } \
        {ESPDIFF INPUT} "holds no atoms"
    # A molecule that is deleted during the run.
    set gone [load_run wild 1]
    set ::ended ""
    set b [espdiff ensemble [list wild [list [list mol $gone]]] -output $scratch/gone {*}$quick -command {set ::ended}]
    mol delete $gone
    vwait ended
    check_refused { espdiff wait $b } {ESPDIFF INPUT} "was deleted during the run"
    check "nothing written" {![file exists $scratch/gone.h5]}
    espdiff delete all
}

finish
