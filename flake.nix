{
  description = "Compiles physics scenes written in TOML into POV-Ray scripts, one per frame";

  inputs.nixpkgs.url = "github:NixOS/nixpkgs/nixos-unstable";

  outputs =
    { self, nixpkgs }:
    let
      systems = [ "x86_64-linux" "aarch64-linux" "x86_64-darwin" "aarch64-darwin" ];
      each = make: nixpkgs.lib.genAttrs systems (system: make nixpkgs.legacyPackages.${system});
      package = (nixpkgs.lib.importTOML ./Cargo.toml).package;
    in
    {
      packages = each (pkgs: {
        default = pkgs.rustPlatform.buildRustPackage {
          pname = package.name;
          inherit (package) version;
          src = self;
          cargoLock.lockFile = ./Cargo.lock;
          cargoBuildFlags = [ "--bin" "jabuka" ];
          # `tests/run` needs a browser, a cluster and more.
          doCheck = false;
          nativeBuildInputs = [ pkgs.installShellFiles pkgs.makeWrapper ];
          postInstall = ''
            $out/bin/jabuka man > jabuka.1
            installManPage jabuka.1
            for shell in bash zsh fish; do
              $out/bin/jabuka completions $shell > jabuka.$shell
            done
            installShellCompletion jabuka.bash jabuka.zsh jabuka.fish
            wrapProgram $out/bin/jabuka --suffix PATH : ${pkgs.lib.makeBinPath [ pkgs.povray pkgs.ffmpeg ]}
          '';
          meta = {
            inherit (package) description;
            license = pkgs.lib.licenses.mit;
            mainProgram = "jabuka";
          };
        };
      });
    };
}
