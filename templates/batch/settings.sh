# shellcheck shell=bash
# Reads the settings of this job from job.conf and then local.conf, for the scripts beside this file.
#
# Each line sets one value: KEY=value. The value is the rest of the line; quotes around all of it are removed. Nothing
# in it is run or expanded: names of scenes and files come from whoever wrote the scene.

# Writes a text for people in one line: control characters and those that reorder text become `?`.
plain() {
    local text=${*//[[:cntrl:]]/?}
    # The bytes of U+061C, U+200E, U+200F, U+2028 to U+202E and U+2066 to U+2069, since the locale is C.
    text=${text//$'\xd8\x9c'/?}
    text=${text//$'\xe2\x80'[$'\x8e\x8f\xa8'-$'\xae']/?}
    text=${text//$'\xe2\x81'[$'\xa6'-$'\xa9']/?}
    printf '%s' "$text"
}

# Ends the script with what is wrong in line `number` of the settings `file`.
wrong_setting() {
    printf '%s: %s, line %s: %s\n' "${0##*/}" "$file" "$number" "$(plain "$1")" >&2
    exit 2
}

# Sets the variables of one file. Bash computes with what numbers hold, so a number must have digits only.
read_settings_of() {
    local file=$1 number=0 line key value
    while IFS= read -r line || [[ -n $line ]]; do
        number=$((number + 1))
        line=${line%$'\r'}
        [[ $line == *[![:space:]]* && $line != '#'* ]] || continue
        [[ $line =~ ^([A-Z_]+)=(.*)$ ]] || wrong_setting "expected KEY=value, found \`$line\`"
        key=${BASH_REMATCH[1]} value=${BASH_REMATCH[2]}
        if [[ $value == [\'\"]* ]]; then
            [[ ${#value} -ge 2 && $value == *"${value:0:1}" ]] ||
                wrong_setting "the quote at the start of the value must be closed at the end of the line"
            value=${value:1:${#value}-2}
        fi
        case $key in
            FILE) FILES+=("$value") ;;
            LAST_FRAME | DIGITS | CHUNK | LIMIT | PROCESSES)
                [[ $value =~ ^[0-9]{1,9}$ ]] || wrong_setting "$key is a number, not \`$value\`"
                printf -v "$key" '%d' "$((10#$value))"
                ;;
            END | FRAME_RATE)
                [[ $value =~ ^[0-9]+(\.[0-9]+)?$ ]] || wrong_setting "$key is a number, not \`$value\`"
                printf -v "$key" '%s' "$value"
                ;;
            FRAMES)
                [[ $value =~ ^[0-9]{1,9}(-[0-9]{1,9})?(,[0-9]{1,9}(-[0-9]{1,9})?)*$ ]] ||
                    wrong_setting "FRAMES is a list such as 7,13-24, not \`$value\`"
                printf -v "$key" '%s' "$value"
                ;;
            BLURRED | TRUST)
                [[ $value == yes || $value == no ]] || wrong_setting "$key is yes or no, not \`$value\`"
                printf -v "$key" '%s' "$value"
                ;;
            JOB | OPTIONS | POVRAY | JABUKA | FFMPEG | VIDEO_OPTIONS) printf -v "$key" '%s' "$value" ;;
            *) wrong_setting "unknown setting \`$key\`" ;;
        esac
    done <"$file"
}

FILES=()
read_settings_of job.conf
[[ ! -f local.conf ]] || read_settings_of local.conf
