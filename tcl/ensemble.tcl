# ensemble.tcl: the command ensemble: groups of simulations through one template; its patches.

namespace eval ::espdiff {
    proc ensemble {options groups} {
        if {![dict get [core::build] hdf5]} { core::ensemble {} {} }  ;# which says why there are none
        set replicates {}
        set frames {}
        if {[dict get $options from] eq ""} {
            lassign [make_replicates $groups [dict get $options frames]] replicates frames
        } else {
            set replicates [members_of_file $groups]
        }
        set handle [core::ensemble $replicates [ensemble_options $options $groups]]
        set source [first_molecule $frames]
        set serve [expr {[dict size $frames] == 0 ? {} : [list ::espdiff::serve_frames $handle $frames]}]
        begin_job $handle $options [dict create serve $serve places [places_of $replicates $frames] source_mol $source target_mol $source]
        foreach warning [finished_warnings $handle] { say $warning }
        return $handle
    }

    # Where each replicate's frames are in VMD: {mol frames} by group and name, without the atoms.
    proc places_of {replicates frames} {
        set places [dict create]
        dict for {number place} $frames {
            set replicate [lindex $replicates $number]
            dict set places [list [dict get $replicate group] [dict get $replicate name]] \
                [list [dict get $place structure mol] [dict get $place frames]]
        }
        return $places
    }

    # Molecule and frame of the template in VMD; empty where it came from a file, or is deleted.
    proc ensemble_template {handle} {
        variable jobs
        set name [core::result $handle]
        if {![dict exists $name plan] || ![dict exists $jobs $handle places]} { return {} }
        set name [dict get $name plan template name]
        dict for {replicate place} [dict get $jobs $handle places] {
            lassign $replicate group label
            set words "$group, replicate $label, frame "
            set at [string last $words $name]
            if {$at < 0} continue
            lassign $place mol frames
            set frame [lindex $frames [string range $name [expr {$at + [string length $words]}] end]]
            if {$mol in [molinfo list] && $frame ne ""} { return [list $mol $frame] }
        }
        return {}
    }

    # What the design cannot show, once that is known.
    proc finished_warnings {handle} {
        if {[dict get [core::status $handle] state] ne "done"} { return {} }
        return [core::ensemble_warnings $handle]
    }

    # The core's options. Names of files are full, because the working folder may change.
    proc ensemble_options {options groups} {
        set core [dict merge [core_options $options] [study_values ensemble $options]]
        dict set core output [file normalize [dict get $options output]]
        dict set core template [full_name [dict get $options template]]
        set column [dict get $options regress]
        if {[set at [string last : $column]] > 0} {
            set column [file normalize [string range $column 0 [expr {$at - 1}]]][string range $column $at end]
        }
        dict set core regress $column
        dict set core charges [concat {*}[named_list -charges {GROUP FILE} [dict get $options charges] {name path} {
            return [list $name [existing_file $path "-charges $name"]]
        }]]
        dict set core maps [concat {*}[named_list -maps {GROUP PATTERN} [dict get $options maps] {name pattern} {
            return [list $name [file normalize $pattern]]
        }]]
        set map [dict get $options map]
        if {$map eq "auto"} { return $core }
        if {![is_computed $map]} {
            fail "-map: '$map' is not auto, pb, pme or coulomb, or one with settings such as {pb ionic_strength 0.1}:\
                an ensemble computes the potential of each frame"
        }
        if {[dict exists [lrange $map 1 end] sel] || [dict exists [lrange $map 1 end] cell]} {
            fail "-map: an ensemble takes the charges of the molecules and their own cells; leave out `sel` and `cell`"
        }
        dict set core map [computed_map $map {file ""} -map]
        return $core
    }

    # The core's replicates, and for each in VMD where its frames are: a dictionary by number.
    proc make_replicates {groups frames} {
        if {![string is list $groups] || [llength $groups] % 2 || [llength $groups] == 0} {
            fail "groups: '$groups' is not a list of a name and a list of replicates, once or twice, such as\
                {wild {{mol 0} {mol 1}} mutant {{mol 2} {mol 3}}}"
        }
        set replicates {}
        set places [dict create]
        foreach {group list} $groups {
            if {![string is list $list] || [llength $list] == 0} { fail "groups: $group has no replicates" }
            foreach text $list {
                set role "replicate [expr {[llength $replicates] + 1}] ($group)"
                set replicate [parse_replicate $text $role]
                if {[dict exists $replicate file]} {
                    lappend replicates [dict merge [list group $group] [file_replicate $replicate $role]]
                } else {
                    lassign [vmd_replicate $replicate $frames $role] core place
                    dict set places [llength $replicates] $place
                    lappend replicates [dict merge [list group $group] $core]
                }
            }
        }
        return [list [name_apart $replicates] $places]
    }

    # Of the file that -from names, in other groups; the core finds them.
    proc members_of_file {groups} {
        if {![string is list $groups] || [llength $groups] % 2} {
            fail "groups: '$groups' is not a list of a name and a list of replicates of -from, once or twice, such as\
                {one {wild/1 wild/2} two {wild/3 wild/4}}"
        }
        set replicates {}
        foreach {group members} $groups {
            foreach member $members { lappend replicates [dict create group $group name $member file [list $member]] }
        }
        return $replicates
    }

    proc parse_replicate {text role} {
        if {![string is list $text] || [llength $text] % 2 || [llength $text] == 0} {
            fail "$role: '$text' is not {mol ID ?sel TEXT? ?frames FRAMES?} or {file PATH ?topology PATH?}"
        }
        set replicate [dict create {*}$text]
        set known [expr {[dict exists $replicate mol] ? {mol sel frames radii whole label} : {file topology label}}]
        if {![dict exists $replicate mol] && ![dict exists $replicate file]} {
            fail "$role: neither `mol ID` (a molecule in VMD) nor `file PATH` is in '$text'"
        }
        foreach key [dict keys $replicate] {
            if {$key ni $known} { fail "$role: [unknown_word key $key $known]" }
        }
        return $replicate
    }

    # One file or a list of them, whose names may have spaces.
    proc file_replicate {replicate role} {
        set given [dict get $replicate file]
        set paths {}
        foreach path [expr {[file exists $given] ? [list $given] : $given}] { lappend paths [existing_file $path $role] }
        set core [dict create file $paths \
            name [value_or $replicate label [lindex [split [file tail [lindex $paths 0]] .] 0]]]
        if {[dict exists $replicate topology]} {
            dict set core topology [existing_file [dict get $replicate topology] "$role, topology"]
        }
        return $core
    }

    # Replicates of one name in a group get numbers.
    proc name_apart {replicates} {
        set count [dict create]
        foreach replicate $replicates { dict incr count [dict get $replicate group]\n[dict get $replicate name] }
        set seen [dict create]
        set result {}
        foreach replicate $replicates {
            set key [dict get $replicate group]\n[dict get $replicate name]
            if {[dict get $count $key] > 1} {
                dict incr seen $key
                dict set replicate name "[dict get $replicate name] #[dict get $seen $key]"
            }
            lappend result $replicate
        }
        return $result
    }

    # Patches as dictionaries, the significant ones first, then those that were asked for.
    proc patches {options handle} {
        require_core_handle $handle
        if {[dict get [core::status $handle] kind] ne "ensemble"} {
            fail "'$handle' is a [dict get [core::status $handle] kind]; patches are of an ensemble"
        }
        set result [core::result $handle]
        set patches {}
        foreach patch [value_or $result patches {}] {
            lappend patches [dict merge [list patch [expr {[llength $patches] + 1}]] $patch]
        }
        if {![dict get $options series]} { return $patches }
        set table [core::read_csv [series_file $handle]]
        set with_series {}
        foreach patch $patches {
            set column patch_[dict get $patch patch]
            set series {}
            foreach row [dict get $table rows] {
                lappend series [list [dict get $row group] [dict get $row replicate] [dict get $row frame] \
                    [dict get $row $column]]
            }
            dict set patch series $series
            lappend with_series $patch
        }
        return $with_series
    }

    proc series_file {handle} {
        foreach path [dict get [core::result $handle] files] {
            if {[string match *.patch_series.csv $path]} { return $path }
        }
        fail "$handle has no patches: it describes one group, or is a part of an ensemble"
    }

    # The options of a drawing: the template is drawn, and what is not significant is `uncertain`, up to a limit of 1.
    proc ensemble_drawing {options handle} {
        if {[dict get $options view] eq "linked"} {
            fail "espdiff draw: -view linked shows a comparison's source, target and difference; leave it out"
        }
        variable jobs
        # The template is a frame of this molecule, whose view it gets.
        lassign [ensemble_template $handle] mol frame
        foreach side {source target} {
            dict set jobs $handle ${side}_mol $mol
            dict set jobs $handle ${side}_frame $frame
        }
        dict set options uncertainty-limit 1
        dict set options surface source
        if {[dict get $options color] eq "auto" && ![dict exists [core::result $handle] test]} {
            dict set options color source
        }
        return $options
    }

    # The quantity by the groups' names, for the legend.
    proc ensemble_title {handle color} {
        set groups {}
        foreach replicate [dict get [core::result $handle] replicates] {
            if {[dict get $replicate group] ni $groups} { lappend groups [dict get $replicate group] }
        }
        lassign $groups first second
        if {[string match *:* $color]} {
            set words [dict create source "mean, $first" target "mean, $second" difference "difference, $second - $first" \
                t "Welch's t, $second - $first"]
            return "[dict get [core::range $handle $color] label]: [dict get $words [lindex [split $color :] end]]"
        }
        dict get [dict create source "Mean potential, $first" target "Mean potential, $second" \
            difference "Potential difference, $second - $first" t "Welch's t, $second - $first" none ""] $color
    }

    # What faded colours and stripes mean, for the legend.
    proc ensemble_key {handle options} {
        set words {}
        set result [core::result $handle]
        if {[dict get $options uncertain] ne "plain" && [dict exists $result test]} {
            set patch [dict get $options patch]
            lappend words [expr {$patch > 0 ? "faded: outside of patch $patch" :
                "faded: not significant, p > [dict get $result options alpha]"}]
        }
        if {[dict get $result tested_area_A2] < [dict get $result area_A2]} { lappend words "hatched: not tested" }
        return [join $words "; "]
    }
}
