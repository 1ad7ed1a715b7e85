# presets.tcl: named groups of settings.

namespace eval ::espdiff::gui {
    # Name, settings that differ from the defaults, help.
    variable presets {
        Default {} "the usual mapping, on a lattice of 1 \u00c5"
        Quick {grid-spacing 1.5} "a lattice of 1.5 \u00c5, in less time: for a first look, or many frames"
        Thorough {grid-spacing 0.7 round-trip 1} "a lattice of 0.7 \u00c5, and the way there and back is checked, in\
            several times the time"
        Thesis {thesis 1} "the deformable surface as first proposed, for comparison with its numbers; for shapes that\
            differ little"
    }
    variable chosen_preset Default

    proc build_presets {path} {
        variable widget
        variable presets
        ttk::frame $path
        set names {}
        set lines {}
        foreach {name settings help} $presets { lappend names $name; lappend lines "$name: $help" }
        ttk::label $path.label -text Preset
        ttk::combobox $path.name -textvariable ::espdiff::gui::chosen_preset -values $names -state readonly -width 10
        bind $path.name <<ComboboxSelected>> {::espdiff::gui::guard ::espdiff::gui::choose_preset}
        tip $path.label [join $lines \n]
        tip $path.name [join $lines \n]
        pack $path.label $path.name -side left -padx {6 0}
        set widget(preset) $path.name
        return $path
    }

    # A preset does not change where the computation runs.
    proc preset_settings {} {
        set changed [dict create]
        foreach {option value} [setting_options] {
            if {$option ni {-device -threads}} { dict set changed [string range $option 1 end] $value }
        }
        return $changed
    }

    proc choose_preset {} {
        variable presets
        variable chosen_preset
        variable setting
        variable standard
        foreach {name settings help} $presets {
            if {$name ne $chosen_preset} continue
            foreach other [array names standard] {
                if {$other ni {device threads}} { set setting($other) $standard($other) }
            }
            foreach {key value} $settings { set setting($key) $value }
            set chosen_preset $name  ;# discards intermediate names
        }
    }

    # The name of the current settings.
    proc show_preset {} {
        variable presets
        variable chosen_preset
        set now [preset_settings]
        foreach {name settings help} $presets {
            if {[dict size $now] != [dict size $settings]} continue
            set same 1
            dict for {key value} $settings {
                if {![dict exists $now $key] || [dict get $now $key] ne $value} { set same 0 }
            }
            if {$same} { set chosen_preset $name; return }
        }
        set chosen_preset "your own"
    }
}
