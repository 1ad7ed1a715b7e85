# potential.tcl: computes potentials from VMD's charges: of one molecule, or averaged over frames.

namespace eval ::espdiff {
    # Computed maps: `map pb`, or {pb ?key value ...?}; the keys are those of core::potential_settings.
    variable potential_kinds {pb pme coulomb}
    variable potential_settings {}

    proc is_computed {text} {
        variable potential_kinds
        expr {[string is list $text] && [lindex $text 0] in $potential_kinds}
    }

    # The keys that one kind of potential takes; `sel` and `cell` are of molecules in VMD.
    proc potential_keys {kind} {
        variable potential_settings
        if {$potential_settings eq ""} { set potential_settings [core::potential_settings] }
        set keys sel
        if {$kind eq "pme"} { lappend keys cell }
        foreach setting $potential_settings {
            if {$kind in [dict get $setting of]} { lappend keys [dict get $setting name] }
        }
        return $keys
    }

    # The options of `espdiff potential` that the core's table has: {name key} pairs. They have the command line's names.
    proc potential_option_keys {} {
        set pairs {}
        foreach setting [core::potential_settings] {
            dict set pairs [dict get $setting map_option] [dict get $setting name]
        }
        return $pairs
    }

    # Their rows for options_of. What is not given is left to the core, since one default may depend on another option.
    proc potential_options {} {
        set rows {}
        foreach setting [core::potential_settings] {
            set default [dict get $setting map_default]
            set help "Of [join_words [dict get $setting of]]: [dict get $setting help]"
            if {$default ne ""} { append help " ($default)" }
            lappend rows [dict create name -[dict get $setting map_option] kind [dict get $setting kind] default {} \
                help $help choices [dict get $setting choices] accepts [dict get $setting accepts] group {} setting 0]
        }
        return $rows
    }

    # The core's map of `text` for an endpoint, which the core has the coordinates of. `because` tells why it was chosen.
    proc computed_map {text endpoint what {because {}}} {
        set kind [lindex $text 0]
        set keys [lrange $text 1 end]
        if {[llength $keys] % 2} { fail "$what: '$text' is not $kind or {$kind ?key value ...?}" }
        set known [potential_keys $kind]
        foreach key [dict keys $keys] {
            if {$key ni $known} { fail "$what: [unknown_word key $key $known]" }
        }
        set map [pme_core_options [dict remove $keys sel]]
        dict set map kind $kind
        if {$because ne ""} { dict set map because $because }
        if {![dict exists $endpoint mol]} {
            if {[dict exists $keys sel]} {
                fail "$what: `sel` selects atoms of a molecule in VMD; of a file all charges count"
            }
            return $map
        }
        # pme takes all charges of the cell; the others those of the atoms that have the surface.
        set mol [vmd_molecule_id [dict get $endpoint mol] $what]
        if {$kind ne "pme" && ![dict exists $keys sel]} {
            vmd_charges $mol [value_or $endpoint sel "not water"] [value_or $endpoint frame now] $what
            return $map
        }
        set frame [value_or $endpoint frame now]
        dict set map charges [vmd_charges $mol [value_or $keys sel all] $frame $what]
        dict set map radii [vmd_radii $mol [value_or $keys sel all] $frame $what]
        dict set map water [vmd_has_water $mol [dict get $map charges]]
        return $map
    }

    # The radii of all atoms, 0 for those that are not selected: a continuum takes their room.
    proc vmd_radii {mol text frame what} {
        set all [atomselect $mol all]
        finally { set radii [$all get radius] } { $all delete }
        if {$text eq "all"} { return $radii }
        set selection [atomselect $mol $text frame [vmd_frame $mol $frame $what]]
        finally {
            set chosen [lrepeat [llength $radii] 0.0]
            foreach index [$selection list] { lset chosen $index [lindex $radii $index] }
        } { $selection delete }
        return $chosen
    }

    proc vmd_has_water {mol charges} {
        set water [atomselect $mol water]
        finally { set atoms [$water list] } { $water delete }
        foreach atom $atoms { if {[lindex $charges $atom] != 0} { return 1 } }
        return 0
    }

    # What a molecule brings for a potential: {name charges solvent}; see core::usual_potential.
    proc potential_facts {endpoint role} {
        if {[dict exists $endpoint file]} {
            set path [existing_file [dict get $endpoint file] $role]
            return [dict merge [list name [file tail $path]] \
                [core::potential_facts $path [value_or $endpoint model 1]]]
        }
        set mol [vmd_molecule_id [dict get $endpoint mol] $role]
        set name [molinfo $mol get name]
        if {[catch { vmd_charges $mol all now $role } charges]} { return [list name $name charges 0 solvent 0] }
        lassign [molinfo $mol get {a b c}] a b c
        set has_cell [expr {min($a, $b, $c) > 1}]
        set solvent [expr {$has_cell && [vmd_has_water $mol $charges]}]
        return [concat [list name $name charges 1 solvent $solvent] [expr {$solvent ? [vmd_salt $mol $charges] : {}}]]
    }

    # What stands in the water: {waters N ions N ion_squares X}; ions as core's salt_ions() finds them.
    proc vmd_salt {mol charges} {
        set water [atomselect $mol water]
        set rest [atomselect $mol "not water"]
        finally {
            set waters [llength [lsort -unique [$water get residue]]]
            foreach residue [$rest get residue] index [$rest get index] { dict lappend atoms $residue $index }
        } {
            $water delete
            $rest delete
        }
        lassign {0 0.0} ions squares
        foreach {residue list} [expr {[info exists atoms] ? $atoms : {}}] {
            set charge [expr {abs([lindex $charges [lindex $list 0]])}]
            if {[llength $list] > 1 || $charge <= 0.5 || $charge >= 1.2} { continue }
            incr ions
            set squares [expr {$squares + $charge * $charge}]
        }
        return [list waters $waters ions $ions ion_squares $squares]
    }

    # Endpoints, each with the potential that is usual for all of them together where the user named none: `map pb` and
    # why under `because`. `map none` compares shapes alone.
    proc with_usual_maps {endpoints} {
        foreach endpoint $endpoints {
            if {![string is list $endpoint] || [llength $endpoint] % 2 || [dict exists $endpoint map]} {
                return $endpoints
            }
            if {![dict exists $endpoint mol] && ![dict exists $endpoint file]} { return $endpoints }
        }
        # What cannot be read is refused where it is read, by its role.
        if {[catch { usual_potential_of $endpoints } choice]} { return $endpoints }
        lassign $choice kind because
        set result {}
        foreach endpoint $endpoints { lappend result [dict merge $endpoint [list map $kind because $because]] }
        return $result
    }

    # The potential that is usual for all endpoints together, and why.
    proc usual_potential_of {endpoints} {
        set facts {}
        foreach endpoint $endpoints { lappend facts [potential_facts $endpoint molecule] }
        return [core::usual_potential $facts]
    }

    # The core calls a given cell `box`; `cell` is the molecule's own.
    proc pme_core_options {options} {
        if {[dict exists $options cell]} {
            dict set options box [dict get $options cell]
            set options [dict remove $options cell]
        }
        return $options
    }

    # The charges of all atoms, 0 for unselected ones.
    proc vmd_charges {mol text frame what} {
        set all [atomselect $mol all]
        finally { set charges [$all get charge] } { $all delete }
        set is_charged 0
        foreach charge $charges { if {$charge != 0} { set is_charged 1; break } }
        if {!$is_charged} { vmd_require_charges [dict create mol $mol charges_origin none] $what }
        if {$text ne "all"} {
            if {[catch { atomselect $mol $text frame [vmd_frame $mol $frame $what] } selection]} {
                fail "$what: the selection '$text' is not understood by VMD ($selection)"
            }
            finally {
                set chosen [lrepeat [llength $charges] 0.0]
                foreach index [$selection list] { lset chosen $index [lindex $charges $index] }
            } { $selection delete }
            set charges $chosen
        }
        foreach charge $charges { if {$charge != 0} { return $charges } }
        fail "$what: no atom of the selection '$text' has a charge"
    }

    # Computes the potential of each frame, averages, and stores the maps as requested.
    proc potential {options} {
        require_vmd "espdiff potential" "outside of it the command line's `espdiff potential` computes maps of files"
        set mol [vmd_molecule_id [dict get $options mol] -mol]
        dict set options mol $mol
        set frames [vmd_frames $mol [dict get $options frames] -frames]
        potential_check $options [llength $frames]
        set each [expr {[dict get $options averaging] eq "each"}]
        set outputs {}
        foreach frame $frames { if {$each} { lappend outputs [potential_file [format .%04d $frame] $options] } }
        if {!$each} { lappend outputs [potential_file "" $options] }
        foreach average {variance error} {
            if {[dict get $options $average]} { lappend outputs [potential_file .$average $options] }
        }
        core::check_outputs [concat [named_files [list mol $mol]] [list [dict get $options xscfile]]] $outputs \
            [dict get $options overwrite]
        set handle [core::potential [potential_core_options $options]]
        finally {
            set begun [clock milliseconds]
            set done 0
            set charges [vmd_charges $mol [dict get $options sel] [lindex $frames 0] -sel]
            if {[dict get $options method] eq "pb" && [vmd_has_water $mol $charges]} {
                fail "espdiff potential: water is selected, and Poisson-Boltzmann has a continuum in its place; give\
                    -sel {not water}, or -method pme"
            }
            set maps [dict create mol {} volumes {} files {}]
            foreach frame $frames {
                if {[dict get $options updatesel]} {
                    set charges [vmd_charges $mol [dict get $options sel] $frame -sel]
                }
                core::potential_frame $handle [potential_frame $mol $frame $charges $options]
                potential_wait $handle [dict get $options progress] $done [llength $frames]
                incr done
                if {$each} { potential_result maps $handle frame [format .%04d $frame] $options }
            }
            if {!$each} { potential_result maps $handle mean "" $options }
            foreach average {variance error} {
                if {[dict get $options $average]} { potential_result maps $handle $average .$average $options }
            }
        } { core::delete $handle }
        return [dict merge [dict create frames [llength $frames]] $maps \
            [dict create seconds [expr {([clock milliseconds] - $begun) / 1000.0}]]]
    }

    proc potential_check {options n_frames} {
        foreach {option least what} {variance 2 variance error 2 "standard error"} {
            if {![dict get $options $option]} continue
            set n [expr {$option eq "error" ? $n_frames / [dict get $options block] : $n_frames}]
            if {$n < $least} { fail "espdiff potential: a $what needs $least frames or blocks of frames; there are $n" }
        }
        if {[dict get $options loadmol] eq "none" && [dict get $options dxfile] eq ""} {
            fail "espdiff potential: with -loadmol none give -dxfile FILE, or nothing would come of it"
        }
        if {[dict get $options loadmol] ni {none same new}} { vmd_molecule_id [dict get $options loadmol] -loadmol }
    }

    proc potential_core_options {options} {
        set core [study_values potential $options]
        foreach key {device threads} { dict set core $key [dict get $options $key] }
        dict for {option key} [potential_option_keys] {
            if {[dict get $options $option] ne ""} { dict set core $key [dict get $options $option] }
        }
        return $core
    }

    proc potential_frame {mol frame charges options} {
        set name "[molinfo $mol get name], frame $frame"
        set result [dict create name $name coordinates [gettimestep $mol $frame] \
            charges $charges \
            radii [vmd_radii $mol [dict get $options sel] $frame -sel] \
            cell [molinfo $mol get {a b c alpha beta gamma} frame $frame]]
        if {[dict get $options align] eq "none"} { return $result }
        set all [atomselect $mol all]
        finally {
            dict set result atoms [$all get {name resname resid insertion chain segname element radius charge}]
        } { $all delete }
        return $result
    }

    proc potential_wait {handle progress done n} {
        variable slice_ms
        while {![core::wait $handle $slice_ms]} {
            if {$progress eq ""} continue
            set code [catch { call_user $progress potential [expr {double($done) / $n}] } message error]
            if {$code ni {0 2 4}} { core::cancel $handle }
            if {$code == 1} { return -options $error $message }
        }
        core::check $handle
    }

    # The name of a map's file; empty where none is asked for.
    proc potential_file {suffix options} {
        set path [dict get $options dxfile]
        if {$path eq ""} { return "" }
        return [file rootname $path]$suffix[file extension $path]
    }

    # Stores a map of the handle as requested, and records it in the caller's dict: mol, volumes, files. `suffix`
    # distinguishes its file. A new molecule is made for the first map, after the computation has succeeded.
    proc potential_result {maps_name handle which suffix options} {
        upvar 1 $maps_name maps
        set file [potential_file $suffix $options]
        if {$file ne ""} {
            dict lappend maps files [core::potential_write $handle $which $file]
        }
        if {[dict get $options loadmol] eq "none"} return
        keep_view {
            if {[dict get $maps mol] eq ""} { dict set maps mol [potential_molecule $options] }
            dict lappend maps volumes [potential_load $handle $which [dict get $maps mol]]
        }
    }

    proc potential_molecule {options} {
        set mol [dict get $options mol]
        switch -- [dict get $options loadmol] {
            same { return $mol }
            new {
                set to [mol new]
                mol rename $to "[molinfo $mol get name] potential"
                return $to
            }
        }
        return [dict get $options loadmol]
    }

    proc potential_load {handle average mol} {
        set name [core::potential_put $handle $average]
        finally { set arrived [vmd_add_volume espdiffmap $name $mol] } { core::forget_volume $name }
        if {!$arrived} {
            set path [temporary_file .dx]
            finally {
                core::potential_write $handle $average $path
                set arrived [vmd_add_volume dx $path $mol]
            } { file delete $path }
        }
        if {!$arrived} { fail "espdiff potential: VMD did not take the map into molecule $mol; see its console" IO }
        return [expr {[molinfo $mol get numvolumedata] - 1}]
    }
}
